#pragma once

#include <filesystem>
#include <string>

#include "calib_tools/colour/overlap.h"
#include "common/geometry/stereo_calibration.h"
#include "common/image/image.h"

namespace vantage {

/// One instant of one rig: its rectified pair and the depth in it.
struct RigSnapshot {
    std::string name;
    StereoCalibration calibration;
    std::string calibration_date;
    ColourImage left, right;  ///< rectified
    DepthImage depth_m;       ///< of the left one; 0 = unknown

    OverlapView overlap_view() const;
};

/// Rectifies a raw pair by the rig's calibration and finds its depth (OpenCV's semi-global
/// matching, left-right checked). Throws Error for pictures of another size than the calibration's.
RigSnapshot make_snapshot(const std::string& name, const StereoCalibration& calibration,
                          const ColourImage& raw_left, const ColourImage& raw_right);

/// From a folder with calibration.yaml (placed by `stage`), left*N.png and right*N.png. Of several
/// pairs the one with this number is taken, or the first for -1. Throws Error naming what is
/// missing.
RigSnapshot load_snapshot(const std::string& name, const std::filesystem::path& folder,
                          long long instant);

}  // namespace vantage

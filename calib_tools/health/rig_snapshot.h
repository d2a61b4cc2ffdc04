#pragma once

#include <filesystem>
#include <string>

#include "calib_tools/colour/overlap.h"
#include "common/geometry/stereo_calibration.h"
#include "common/image/image.h"

namespace vantage {

/// One rectified image pair of a rig and its depth.
struct RigSnapshot {
    std::string name;
    StereoCalibration calibration;
    std::string calibration_date;
    ColourImage left, right;  ///< rectified
    DepthImage depth_m;       ///< of the left image; 0 = unknown

    OverlapView overlap_view() const;
};

/// Rectifies a raw pair with the rig's calibration and computes its depth (OpenCV's semi-global
/// matching with a left-right check). Throws Error for images with another size than the
/// calibration.
RigSnapshot make_snapshot(const std::string& name, const StereoCalibration& calibration,
                          const ColourImage& raw_left, const ColourImage& raw_right);

/// Loads a snapshot from a folder with calibration.yaml (placed by `stage`), left*N.png and
/// right*N.png. `instant` selects the pair with this number, or the first for -1. Throws Error that
/// names the missing file.
RigSnapshot load_snapshot(const std::string& name, const std::filesystem::path& folder,
                          long long instant);

}  // namespace vantage

#pragma once

#include <string>
#include <vector>

#include "calib_tools/bundle/bundle.h"

namespace vantage {

/// How well the views of one camera fill what a calibration needs.
struct Coverage {
    static constexpr int columns = 8, rows = 6;  ///< cells of the picture
    int corners_in_cell[rows][columns] = {};
    double covered_share = 0;  ///< of the cells
    /// Largest tilt of a board about the picture's vertical and horizontal axis, either way.
    double tilt_left_deg = 0, tilt_right_deg = 0, tilt_up_deg = 0, tilt_down_deg = 0;
    double nearest_m = 0, farthest_m = 0;  ///< board's middle, along the axis
};

Coverage measure_coverage(const Bundle& bundle, int camera);

/// Which pictures would help this camera most, a sentence each; empty if nothing is missing.
/// `camera_name` stands in the sentences ("left").
std::vector<std::string> missing_pictures(const Bundle& bundle, int camera,
                                          const std::string& camera_name);

}  // namespace vantage

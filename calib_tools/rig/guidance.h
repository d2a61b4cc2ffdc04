#pragma once

#include <string>
#include <vector>

#include "calib_tools/bundle/bundle.h"

namespace vantage {

/// How well the views of one camera cover the image and the poses that a calibration needs.
struct Coverage {
    static constexpr int columns = 8, rows = 6;  ///< cells of the picture
    int corners_in_cell[rows][columns] = {};
    double covered_share = 0;  ///< share of the cells
    /// Largest tilts of a board about the vertical and the horizontal axis of the image, in each
    /// direction.
    double tilt_left_deg = 0, tilt_right_deg = 0, tilt_up_deg = 0, tilt_down_deg = 0;
    double nearest_m = 0,
           farthest_m = 0;  ///< distance of the board's centre along the optical axis
};

Coverage measure_coverage(const Bundle& bundle, int camera);

/// Lists the images that would help this camera most, one sentence each; empty if nothing is
/// missing. `camera_name` ("left") appears in the sentences.
std::vector<std::string> missing_pictures(const Bundle& bundle, int camera,
                                          const std::string& camera_name);

}  // namespace vantage

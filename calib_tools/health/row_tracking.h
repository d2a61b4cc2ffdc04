#pragma once

#include <vector>

#include <Eigen/Core>

#include "common/image/image.h"

namespace vantage {

/// Feature of the left image and its vertical offset in the right image.
struct TrackedRow {
    Eigen::Vector2d left_px;
    double disparity_px = 0;
    double row_miss_px = 0;  ///< right minus left
};

/// Tracks up to `most` corners of the rectified left image in the right one by normalised
/// correlation, over all disparities and several rows, to a fraction of a pixel. Ambiguous and bad
/// matches are left out.
std::vector<TrackedRow> track_rows(const GreyImage& left, const GreyImage& right, int most);

}  // namespace vantage

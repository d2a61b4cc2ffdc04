#pragma once

#include <vector>

#include <Eigen/Core>

#include "common/image/image.h"

namespace vantage {

/// A feature of the left picture and how far above or below its row the right picture shows it.
struct TrackedRow {
    Eigen::Vector2d left_px;
    double disparity_px = 0;
    double row_miss_px = 0;  ///< right minus left
};

/// Follows up to `most` corners of the rectified left picture into the right one by normalised
/// correlation, over all disparities and several rows, to a fraction of a pixel. Features that fit
/// at several places, or badly, are left out.
std::vector<TrackedRow> track_rows(const GreyImage& left, const GreyImage& right, int most);

}  // namespace vantage

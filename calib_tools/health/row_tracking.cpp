#include "calib_tools/health/row_tracking.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <opencv2/imgproc.hpp>

#include "calib_tools/health/patch_search.h"

namespace vantage {
namespace {

constexpr int half_row_patch_px = 7, rows_px = 6;
constexpr double good_row_match = 0.9;

}  // namespace

std::vector<TrackedRow> track_rows(const GreyImage& left, const GreyImage& right, int most) {
    constexpr double quality = 0.02;
    std::vector<cv::Point2f> corners;
    cv::goodFeaturesToTrack(left, corners, most, quality, 2 * half_row_patch_px);
    std::vector<TrackedRow> rows;
    const int margin = half_row_patch_px + rows_px + 1;
    for (const cv::Point2f& corner : corners) {
        const int x = static_cast<int>(std::lround(corner.x));
        const int y = static_cast<int>(std::lround(corner.y));
        if (x < margin || y < margin || x >= left.cols - margin || y >= left.rows - margin)
            continue;
        const cv::Rect patch(x - half_row_patch_px, y - half_row_patch_px,
                             2 * half_row_patch_px + 1, 2 * half_row_patch_px + 1);
        const int reach = std::min(x - margin, left.cols / 3);
        const cv::Rect area(patch.x - reach, patch.y - rows_px, patch.width + reach + 1,
                            patch.height + 2 * rows_px);
        const std::optional<Eigen::Vector2d> found =
            find_patch(right(area), left(patch), good_row_match);
        if (found) rows.push_back({{x, y}, reach - found->x(), found->y() - rows_px});
    }
    return rows;
}

}  // namespace vantage

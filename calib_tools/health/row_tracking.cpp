#include "calib_tools/health/row_tracking.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

constexpr int half_patch_px = 7, rows_px = 6;
constexpr double good_match = 0.9, rival_share = 0.93;

/// Where a parabola through three neighbouring values has its top, -0.5 to 0.5.
double top_of(float before, float at, float after) {
    const double curve = before - 2.0 * at + after;
    return curve < 0 ? std::clamp(0.5 * (before - after) / curve, -0.5, 0.5) : 0;
}

}  // namespace

std::vector<TrackedRow> track_rows(const GreyImage& left, const GreyImage& right, int most) {
    constexpr double quality = 0.02;
    std::vector<cv::Point2f> corners;
    cv::goodFeaturesToTrack(left, corners, most, quality, 2 * half_patch_px);
    std::vector<TrackedRow> rows;
    const int margin = half_patch_px + rows_px + 1;
    for (const cv::Point2f& corner : corners) {
        const int x = static_cast<int>(std::lround(corner.x));
        const int y = static_cast<int>(std::lround(corner.y));
        if (x < margin || y < margin || x >= left.cols - margin || y >= left.rows - margin)
            continue;
        const cv::Rect patch(x - half_patch_px, y - half_patch_px, 2 * half_patch_px + 1,
                             2 * half_patch_px + 1);
        const int reach = std::min(x - margin, left.cols / 3);
        const cv::Rect area(patch.x - reach, patch.y - rows_px, patch.width + reach + 1,
                            patch.height + 2 * rows_px);
        cv::Mat1f fit;
        cv::matchTemplate(right(area), left(patch), fit, cv::TM_CCOEFF_NORMED);
        double best = 0;
        cv::Point at;
        cv::minMaxLoc(fit, nullptr, &best, nullptr, &at);
        if (best < good_match || at.x < 1 || at.y < 1 || at.x >= fit.cols - 1 ||
            at.y >= fit.rows - 1)
            continue;
        const TrackedRow row{
            {x, y},
            reach - at.x - top_of(fit(at.y, at.x - 1), fit(at), fit(at.y, at.x + 1)),
            at.y - rows_px + top_of(fit(at.y - 1, at.x), fit(at), fit(at.y + 1, at.x))};
        // The same texture elsewhere in the row would make it a guess.
        cv::circle(fit, at, 3, cv::Scalar(-1), cv::FILLED);
        double rival = 0;
        cv::minMaxLoc(fit, nullptr, &rival);
        if (rival < rival_share * best) rows.push_back(row);
    }
    return rows;
}

}  // namespace vantage

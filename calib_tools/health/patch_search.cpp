#include "calib_tools/health/patch_search.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

constexpr double rival_share = 0.93;
constexpr int same_peak_px = 3;

/// Position of the maximum of a parabola through three neighbouring values, -0.5 to 0.5.
double top_of(float before, float at, float after) {
    const double curve = before - 2.0 * at + after;
    return curve < 0 ? std::clamp(0.5 * (before - after) / curve, -0.5, 0.5) : 0;
}

}  // namespace

std::optional<Eigen::Vector2d> find_patch(const GreyImage& area, const GreyImage& patch,
                                          double fewest) {
    cv::Mat1f fit;
    cv::matchTemplate(area, patch, fit, cv::TM_CCOEFF_NORMED);
    double best = 0;
    cv::Point at;
    cv::minMaxLoc(fit, nullptr, &best, nullptr, &at);
    if (best < fewest || at.x < 1 || at.y < 1 || at.x >= fit.cols - 1 || at.y >= fit.rows - 1)
        return std::nullopt;
    const Eigen::Vector2d found(at.x + top_of(fit(at.y, at.x - 1), fit(at), fit(at.y, at.x + 1)),
                                at.y + top_of(fit(at.y - 1, at.x), fit(at), fit(at.y + 1, at.x)));
    cv::circle(fit, at, same_peak_px, cv::Scalar(-1), cv::FILLED);
    double rival = 0;
    cv::minMaxLoc(fit, nullptr, &rival);
    if (rival >= rival_share * best) return std::nullopt;
    return found;
}

}  // namespace vantage

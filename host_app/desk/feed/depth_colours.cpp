#include "host_app/desk/feed/depth_colours.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

/// Of the depths at either end, left out of the range.
constexpr double end_share = 0.02;
/// Of the way to the new range, a picture.
constexpr double follow_share = 0.1;
/// A wall has a range too.
constexpr double least_ratio = 1.1;
constexpr int colours = 256;

std::vector<cv::Vec4b> cividis() {
    cv::Mat1b ramp(1, colours);
    for (int i = 0; i < colours; ++i) ramp(0, i) = static_cast<unsigned char>(i);
    cv::Mat3b bgr;
    cv::applyColorMap(ramp, bgr, cv::COLORMAP_CIVIDIS);
    std::vector<cv::Vec4b> table;
    for (const cv::Vec3b& c : bgr) table.emplace_back(c[2], c[1], c[0], 255);
    return table;
}

}  // namespace

DepthImage depth_of(const DisparityImage& disparity, const DisparityScale& scale) {
    DepthImage depth(disparity.size());
    std::transform(disparity.begin(), disparity.end(), depth.begin(),
                   [&](std::uint16_t steps) { return scale.depth_m(steps); });
    return depth;
}

void DepthRange::follow(const DepthImage& depth) {
    std::vector<float> known;
    for (const float m : depth)
        if (m > 0) known.push_back(m);
    if (known.empty()) return;
    const auto at = [&](double share) {
        const auto place = known.begin() + static_cast<std::ptrdiff_t>(
                                               share * static_cast<double>(known.size() - 1));
        std::nth_element(known.begin(), place, known.end());
        return static_cast<double>(*place);
    };
    const double nearest = at(end_share), farthest = at(1 - end_share);
    const double share = nearest_m > 0 ? follow_share : 1;
    nearest_m += share * (nearest - nearest_m);
    farthest_m += share * (farthest - farthest_m);
}

ColourImage depth_colours(const DepthImage& depth, const DepthRange& range) {
    static const std::vector<cv::Vec4b> table = cividis();
    ColourImage picture(depth.size(), cv::Vec4b(0, 0, 0, 255));
    if (range.nearest_m <= 0) return picture;
    const double most = std::max(range.farthest_m, least_ratio * range.nearest_m);
    const double scale = (colours - 1) / std::log(most / range.nearest_m);
    std::transform(depth.begin(), depth.end(), picture.begin(), [&](float m) {
        if (m <= 0) return cv::Vec4b(0, 0, 0, 255);
        const double nearness = scale * std::log(most / m);
        return table[static_cast<std::size_t>(std::clamp(nearness, 0.0, colours - 1.0))];
    });
    return picture;
}

}  // namespace vantage

#include "tests/references/stereo/sgm_reference.h"

#include <algorithm>

namespace vantage {
namespace {

/// Adds the sums of the path that comes to each pixel from (x - dx, y - dy).
void add_path(std::vector<cv::Mat1i>& sums, const std::vector<cv::Mat1b>& costs, int dx, int dy,
              const SgmSettings& settings) {
    const cv::Size size = costs.front().size();
    const std::size_t disparities = costs.size();
    std::vector<std::vector<int>> rest(static_cast<std::size_t>(size.area()));
    for (int j = 0; j < size.height; ++j)
        for (int i = 0; i < size.width; ++i) {
            const int x = dx < 0 ? size.width - 1 - i : i, y = dy < 0 ? size.height - 1 - j : j;
            const int from_x = x - dx, from_y = y - dy;
            const bool is_first =
                from_x < 0 || from_x >= size.width || from_y < 0 || from_y >= size.height;
            const std::vector<int> q =
                is_first ? std::vector<int>(disparities, 0)
                         : rest[static_cast<std::size_t>(from_y * size.width + from_x)];
            std::vector<int>& sum = rest[static_cast<std::size_t>(y * size.width + x)];
            sum.resize(disparities);
            for (std::size_t d = 0; d < disparities; ++d) {
                const int below = d > 0 ? q[d - 1] : settings.p2;
                const int above = d + 1 < disparities ? q[d + 1] : settings.p2;
                sum[d] = costs[d](y, x) + std::min(q[d], std::min(below, above) + settings.p1);
                sums[d](y, x) += sum[d];
            }
            const int least = std::ranges::min(sum);
            for (int& value : sum) value = std::min(value - least, settings.p2);
        }
}

}  // namespace

Winners sgm_winners(const std::vector<cv::Mat1b>& costs, const SgmSettings& settings) {
    const cv::Size size = costs.front().size();
    std::vector<cv::Mat1i> sums;
    for (std::size_t d = 0; d < costs.size(); ++d) sums.emplace_back(size, 0);
    for (const int step : {-1, 1}) {
        add_path(sums, costs, step, 0, settings);
        if (settings.columns) add_path(sums, costs, 0, step, settings);
    }
    Winners winners = no_winners(size);
    cv::Mat1i last(size, no_cost);
    for (std::size_t d = 0; d < sums.size(); ++d)
        consider_disparity(winners, last, sums[d], static_cast<int>(d));
    return winners;
}

std::vector<cv::Mat1b> sgm_costs(const cv::Mat1i& left_features, const cv::Mat1i& right_features,
                                 int disparities, int scale) {
    std::vector<cv::Mat1b> costs;
    for (int d = 0; d < disparities; ++d) {
        cv::Mat1b& picture = costs.emplace_back(left_features.size());
        for (int y = 0; y < picture.rows; ++y)
            for (int x = 0; x < picture.cols; ++x)
                picture(y, x) = static_cast<unsigned char>(
                    scale *
                    feature_cost(left_features(y, x), feature_at(right_features, x - d, y)));
    }
    return costs;
}

}  // namespace vantage

#include "tests/references/stereo/halved_cost_reference.h"

#include <algorithm>

#include "tests/references/stereo/perm_reference.h"

namespace vantage {

std::vector<cv::Mat1b> halved_costs(const cv::Mat1i& left_features, const cv::Mat1i& right_features,
                                    int disparities, HalvedCostSamples samples) {
    const auto least_around = [&](int x, int y, int d) {
        int least = most_feature_cost;
        for (int near = std::max(d - 1, 0); near <= d + 1; ++near)
            least = std::min(
                least, feature_cost(left_features(y, x), feature_at(right_features, x - near, y)));
        return least;
    };
    std::vector<cv::Mat1b> costs;
    for (int d = 0; d < halved_disparities(disparities); ++d) {
        cv::Mat1b& picture =
            costs.emplace_back((left_features.rows + 1) / 2, left_features.cols / 2);
        for (int y = 0; y < picture.rows; ++y)
            for (int x = 0; x < picture.cols; ++x) {
                const int below = std::min(2 * y + 1, left_features.rows - 1);
                const bool is_lower = samples == HalvedCostSamples::one && y % 2 == 1;
                int cost = least_around(2 * x + 1, is_lower ? below : 2 * y, 2 * d);
                if (samples == HalvedCostSamples::two)
                    cost = (cost + least_around(2 * x, below, 2 * d) + 1) >> 1;
                picture(y, x) = static_cast<unsigned char>(cost);
            }
    }
    return costs;
}

std::vector<cv::Mat1b> paired_costs(const cv::Mat1i& left_features, const cv::Mat1i& right_features,
                                    int disparities) {
    std::vector<cv::Mat1b> costs;
    for (int d = 0; d < disparities; ++d) {
        cv::Mat1b& picture = costs.emplace_back((left_features.rows + 1) / 2, left_features.cols);
        for (int y = 0; y < picture.rows; ++y)
            for (int x = 0; x < picture.cols; ++x) {
                const auto cost_in = [&](int row) {
                    return feature_cost(left_features(row, x),
                                        feature_at(right_features, x - d, row));
                };
                const int below = std::min(2 * y + 1, left_features.rows - 1);
                picture(y, x) =
                    static_cast<unsigned char>((cost_in(2 * y) + cost_in(below) + 1) >> 1);
            }
    }
    return costs;
}

}  // namespace vantage

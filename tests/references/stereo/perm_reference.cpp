#include "tests/references/stereo/perm_reference.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace vantage {
namespace {

/// The sum of a line's costs from both sides without its low `shift` bits, each step damped by its
/// permeability; costs[0] is the first of mu.size() values `step` apart.
void permeate_line(int* costs, std::size_t step, const std::vector<int>& mu, int shift) {
    std::vector<int> forward(mu.size());
    int sum = 0;
    for (std::size_t i = 0; i < forward.size(); ++i) {
        forward[i] = sum = costs[i * step] + ((sum * mu[i]) >> 4);
    }
    int back = 0;
    for (std::size_t i = forward.size(); i-- > 0;) {
        back = i + 1 < forward.size() ? (back * mu[i + 1]) >> 4 : 0;
        const int cost = costs[i * step];
        costs[i * step] = (forward[i] + back) >> shift;
        back += cost;
    }
}

/// Horizontal sums lose their low three bits, vertical ones none.
void permeate_picture(cv::Mat1i& costs, const cv::Mat1b& permeability) {
    std::vector<int> mu;
    for (int y = 0; y < costs.rows; ++y) {
        mu.clear();
        for (int x = 0; x < costs.cols; ++x) mu.push_back(permeability(y, x) & 15);
        permeate_line(costs[y], 1, mu, 3);
    }
    for (int x = 0; x < costs.cols; ++x) {
        mu.clear();
        for (int y = 0; y < costs.rows; ++y) mu.push_back(permeability(y, x) >> 4);
        permeate_line(&costs(0, x), static_cast<std::size_t>(costs.cols), mu, 0);
    }
}

}  // namespace

int feature_cost(int left, int right) {
    const auto l = static_cast<std::uint32_t>(left), r = static_cast<std::uint32_t>(right);
    // The shorter way on a circle of 32 levels.
    const auto way = [&](int first_bit) {
        const std::uint32_t levels = ((l >> first_bit) - (r >> first_bit)) & 31U;
        return static_cast<int>(std::min(levels, 32 - levels));
    };
    const int census = std::popcount((l ^ r) & 0x1ffffU);
    return std::min(census, 9) +
           2 * (std::min(way(27), 3) + std::min(way(17), 4) + std::min(way(22), 4));
}

Winners no_winners(cv::Size size) {
    return {cv::Mat1i(size, 0), cv::Mat1i(size, no_cost), cv::Mat1i(size, no_cost),
            cv::Mat1i(size, no_cost), cv::Mat1i(size, 16)};
}

void consider_disparity(Winners& winners, cv::Mat1i& last, const cv::Mat1i& costs, int d) {
    for (int y = 0; y < costs.rows; ++y)
        for (int x = 0; x < costs.cols; ++x) {
            const int cost = costs(y, x);
            if (d > 0 && winners.disparity(y, x) == d - 1) winners.cost_after(y, x) = cost;
            if (cost < winners.cost(y, x)) {
                winners.cost(y, x) = cost;
                winners.disparity(y, x) = d;
                winners.cost_before(y, x) = last(y, x);
                winners.cost_after(y, x) = no_cost;
            }
            last(y, x) = cost;
        }
}

namespace {

cv::Mat1i matching_cost(const cv::Mat1i& left, const cv::Mat1i& right, int d) {
    cv::Mat1i costs(left.size());
    for (int y = 0; y < costs.rows; ++y)
        for (int x = 0; x < costs.cols; ++x)
            costs(y, x) = feature_cost(left(y, x), feature_at(right, x - d, y));
    return costs;
}

cv::Mat1i weight_of(const cv::Mat1b& permeability) {
    cv::Mat1i weight(permeability.size(), most_feature_cost);
    permeate_picture(weight, permeability);
    return weight;
}

cv::Mat1i perm_sums(const cv::Mat1i& left, const cv::Mat1i& right, const cv::Mat1b& permeability,
                    int d) {
    cv::Mat1i costs = matching_cost(left, right, d);
    permeate_picture(costs, permeability);
    return costs;
}

/// How a sum becomes a cost of at most most_code, which is where every cost is the largest.
struct CostScale {
    int shift, factor;
};

CostScale scale_of(int weight, int most_code) {
    const int shift = (weight >= 256) + (weight >= 512) + (weight >= 1024) + (weight >= 2048);
    const float factor = static_cast<float>(most_code) * 256.0f * static_cast<float>(1 << shift) /
                         static_cast<float>(std::max(weight, 1));
    return {shift, static_cast<int>(factor)};
}

}  // namespace

Winners perm_winners(const cv::Mat1i& left_features, const cv::Mat1i& right_features,
                     const cv::Mat1b& permeability, int disparities) {
    Winners winners = no_winners(left_features.size());
    winners.weight = weight_of(permeability);
    cv::Mat1i last(left_features.size(), no_cost);
    for (int d = 0; d < disparities; ++d)
        consider_disparity(winners, last, perm_sums(left_features, right_features, permeability, d),
                           d);
    return winners;
}

std::vector<cv::Mat1b> perm_costs(const cv::Mat1i& left_features, const cv::Mat1i& right_features,
                                  const cv::Mat1b& permeability, int disparities) {
    std::vector<cv::Mat1b> costs;
    for (int d = 0; d < disparities; ++d)
        matching_cost(left_features, right_features, d).convertTo(costs.emplace_back(), CV_8U);
    return perm_costs(costs, permeability);
}

std::vector<cv::Mat1b> perm_costs(const std::vector<cv::Mat1b>& costs,
                                  const cv::Mat1b& permeability, int most_code) {
    const cv::Mat1i weight = weight_of(permeability);
    std::vector<cv::Mat1b> result;
    for (const cv::Mat1b& picture : costs) {
        cv::Mat1i sums;
        picture.convertTo(sums, CV_32S);
        permeate_picture(sums, permeability);
        cv::Mat1b& codes = result.emplace_back(sums.size());
        for (int y = 0; y < sums.rows; ++y)
            for (int x = 0; x < sums.cols; ++x) {
                const CostScale by = scale_of(weight(y, x), most_code);
                codes(y, x) =
                    static_cast<unsigned char>(((sums(y, x) >> by.shift) * by.factor) >> 8);
            }
    }
    return result;
}

}  // namespace vantage

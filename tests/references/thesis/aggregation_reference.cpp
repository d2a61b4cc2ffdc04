#include "tests/references/thesis/aggregation_reference.h"

#include "tests/references/thesis/discontinuity_reference.h"

namespace vantage::thesis {
namespace {

struct Weights {
    int before, centre, after;
};
/// By cut before + 2 * cut after.
constexpr Weights table[4] = {{3, 2, 3}, {0, 5, 3}, {3, 5, 0}, {0, 8, 0}};

}  // namespace

CostVolume aggregation_reference(const CostVolume& costs, const cv::Mat1b& discontinuities) {
    CostVolume aggregated(costs.width_px, costs.height_px, costs.disparities);
    cv::Mat1i row_sums(costs.height_px, costs.width_px);
    for (int d = 0; d < costs.disparities; ++d) {
        for (int y = 0; y < costs.height_px; ++y)
            for (int x = 0; x < costs.width_px; ++x) {
                const int cuts = discontinuities(y, x);
                const Weights& w = table[((cuts & cut_left) != 0) + 2 * ((cuts & cut_right) != 0)];
                row_sums(y, x) = w.centre * costs.at(d, y, x);
                if (w.before) row_sums(y, x) += w.before * costs.at(d, y, x - 1);
                if (w.after) row_sums(y, x) += w.after * costs.at(d, y, x + 1);
            }
        for (int y = 0; y < costs.height_px; ++y)
            for (int x = 0; x < costs.width_px; ++x) {
                const int cuts = discontinuities(y, x);
                const Weights& w = table[((cuts & cut_above) != 0) + 2 * ((cuts & cut_below) != 0)];
                int sum = w.centre * row_sums(y, x);
                if (w.before) sum += w.before * row_sums(y - 1, x);
                if (w.after) sum += w.after * row_sums(y + 1, x);
                aggregated.at(d, y, x) = static_cast<std::uint16_t>((sum + 32) / 64);
            }
    }
    return aggregated;
}

}  // namespace vantage::thesis

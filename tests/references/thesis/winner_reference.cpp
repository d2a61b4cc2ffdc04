#include "tests/references/thesis/winner_reference.h"

namespace vantage::thesis {

cv::Mat1b winner_reference(const CostVolume& costs) {
    cv::Mat1b winners(costs.height_px, costs.width_px);
    for (int y = 0; y < winners.rows; ++y)
        for (int x = 0; x < winners.cols; ++x) {
            int winner = 0;
            for (int d = 1; d < costs.disparities; ++d)
                if (costs.at(d, y, x) < costs.at(winner, y, x)) winner = d;
            winners(y, x) = static_cast<unsigned char>(winner);
        }
    return winners;
}

}  // namespace vantage::thesis

#include "tests/references/thesis/disparity_reference.h"

#include <algorithm>

namespace vantage::thesis {

DisparityImage disparity_reference(const cv::Mat1b& winners, bool fill) {
    DisparityImage disparity(winners.size());
    for (int y = 0; y < winners.rows; ++y) {
        std::uint16_t next_match = 0;
        for (int x = winners.cols - 1; x >= 0; --x) {
            const int d = winners(y, x);
            const bool has_match = d <= x;
            if (has_match)
                next_match = static_cast<std::uint16_t>(std::max(d * disparity_steps_per_px, 1));
            disparity(y, x) = has_match || fill ? next_match : std::uint16_t{0};
        }
    }
    return disparity;
}

}  // namespace vantage::thesis

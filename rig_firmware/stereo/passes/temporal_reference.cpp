#include "rig_firmware/stereo/passes/temporal_reference.h"

#include <algorithm>
#include <cstdlib>

namespace vantage {

DisparityImage TemporalReference::run(const DisparityImage& disparity, const GreyImage& luma) {
    cv::Mat1i mean(disparity.size());
    DisparityImage steadied(disparity.size());
    const auto change = [&](int x, int y) {
        x = std::clamp(x, 0, luma.cols - 1);
        y = std::clamp(y, 0, luma.rows - 1);
        return std::abs(luma(y, x) - luma_(y, x));
    };
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x) {
            const int now = disparity(y, x) << 8;
            mean(y, x) = now;
            if (!mean_.empty() && now != 0) {
                const int before = mean_(y, x);
                const int changed = change(x, y) + change(x + 1, y) + change(x - 1, y) +
                                    change(x, y + 1) + change(x, y - 1);
                if (before != 0 && changed <= 40 && std::abs(now - before) <= 12288)
                    mean(y, x) = before + ((now - before) >> 2);
            }
            steadied(y, x) =
                static_cast<unsigned short>(now == 0 ? 0 : std::max((mean(y, x) + 128) >> 8, 1));
        }
    mean_ = mean;
    luma_ = luma.clone();
    return steadied;
}

}  // namespace vantage

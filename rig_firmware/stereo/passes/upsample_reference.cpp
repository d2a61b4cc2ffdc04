#include "rig_firmware/stereo/passes/upsample_reference.h"

#include <algorithm>
#include <cstdlib>

namespace vantage {

DisparityImage upsampled(const DisparityImage& coarse, const GreyImage& coarse_luma,
                         const GreyImage& fine_luma) {
    DisparityImage fine(fine_luma.size());
    for (int y = 0; y < fine.rows; ++y)
        for (int x = 0; x < fine.cols; ++x) {
            // In quarters of a coarse pixel: a fine pixel lies a quarter beside its coarse one's
            // middle.
            const auto far = [](int step, int odd) { return std::abs(4 * step - (odd ? 1 : -1)); };
            const auto unlike = [&](int dx, int dy, int cx, int cy) {
                return std::abs(fine_luma(y, x) - coarse_luma(cy, cx)) + far(dx, x % 2) +
                       far(dy, y % 2);
            };
            int least = unlike(0, 0, x / 2, y / 2);
            int best = coarse(y / 2, x / 2);
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    if (dx == 0 && dy == 0) continue;
                    const int cx = std::clamp(x / 2 + dx, 0, coarse.cols - 1),
                              cy = std::clamp(y / 2 + dy, 0, coarse.rows - 1);
                    const int here = unlike(dx, dy, cx, cy);
                    if (here < least) {
                        least = here;
                        best = coarse(cy, cx);
                    }
                }
            fine(y, x) = static_cast<unsigned short>(2 * best);
        }
    return fine;
}

}  // namespace vantage

#include "tests/references/stereo/support_reference.h"

#include <algorithm>
#include <cstdlib>

#include "rig_firmware/stereo/disparity/row_fill_pass.h"

namespace vantage {

DisparityImage supported_disparity(const DisparityImage& disparity) {
    DisparityImage supported(disparity.size(), 0);
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x) {
            const int centre = disparity(y, x);
            if (!centre) continue;
            int votes = 0;
            for (int dy = -4; dy <= 4; dy += 2)
                for (int dx = -4; dx <= 4; dx += 2) {
                    const int vote = disparity(std::clamp(y + dy, 0, disparity.rows - 1),
                                               std::clamp(x + dx, 0, disparity.cols - 1));
                    votes += vote && std::abs(vote - centre) <= disparity_steps_per_px ? 1 : 0;
                }
            if (votes >= SupportPass::min_support) supported(y, x) = disparity(y, x);
        }
    return supported;
}

}  // namespace vantage

#include "tests/references/stereo/temporal_reference.h"

#include <algorithm>
#include <cstdlib>

#include "rig_firmware/stereo/disparity/temporal_pass.h"

namespace vantage {

DisparityImage TemporalReference::run(const DisparityImage& disparity, const GreyImage& luma) {
    constexpr int most_mean = 0x7ffff;
    const int gain = exposure_.gain_4096(luma);
    cv::Mat1i means(disparity.size()), votes(disparity.size(), 0);
    DisparityImage denoised(disparity.size());
    GreyImage mean_luma = luma.clone();
    const auto change = [&](int x, int y) {
        x = std::clamp(x, 0, luma.cols - 1);
        y = std::clamp(y, 0, luma.rows - 1);
        return std::abs(luma(y, x) - exposed(luma_(y, x), gain, 255));
    };
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x) {
            const int now = std::min(disparity(y, x) << 5, most_mean);
            int& mean = means(y, x);
            mean = now;
            if (!mean_.empty() && now != 0) {
                const int before = mean_(y, x), votes_before = votes_(y, x);
                const int changed = change(x, y) + change(x + 1, y) + change(x - 1, y) +
                                    change(x, y + 1) + change(x, y - 1);
                const int luma_before = exposed(luma_(y, x), gain, 255);
                if (changed <= TemporalPass::max_still_change)
                    mean_luma(y, x) = static_cast<unsigned char>(
                        luma_before + ((luma(y, x) - luma_before + 2) >> 2));
                const bool agrees = std::abs(now - before) <= TemporalPass::max_consistent_step;
                if (before != 0 && agrees && changed <= TemporalPass::max_still_change) {
                    mean = before + ((now - before) >> (votes_before < 8 ? 2 : 3));
                    votes(y, x) = std::min(votes_before + TemporalPass::consistent_score,
                                           TemporalPass::max_score);
                } else if (before != 0 && !agrees && changed <= TemporalPass::max_holding_change) {
                    mean = votes_before > 0 ? before : now;
                    votes(y, x) = votes_before > 0 ? votes_before - 1 : TemporalPass::first_score;
                }
            }
            denoised(y, x) =
                static_cast<unsigned short>(now == 0 ? 0 : std::max((mean + 16) >> 5, 1));
        }
    mean_ = means;
    votes_ = votes;
    luma_ = mean_luma;
    return denoised;
}

}  // namespace vantage

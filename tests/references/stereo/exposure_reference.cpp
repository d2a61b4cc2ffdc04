#include "tests/references/stereo/exposure_reference.h"

#include <algorithm>
#include <cstdlib>

#include "rig_firmware/stereo/features/exposure_pass.h"

namespace vantage {

int ExposureReference::gain_4096(const GreyImage& luma) {
    constexpr int columns = ExposurePass::columns, rows = ExposurePass::rows;
    std::vector<int> samples;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
            samples.push_back(luma((2 * j + 1) * luma.rows / (2 * rows),
                                   (2 * i + 1) * luma.cols / (2 * columns)));
    int gain = 4096;
    if (!luma_.empty()) {
        for (const int step : {ExposurePass::max_first_change, ExposurePass::max_change}) {
            int now = 0, before = 0, count = 0;
            for (std::size_t i = 0; i < samples.size(); ++i)
                if (std::abs(samples[i] - ((luma_[i] * gain + 2048) >> 12)) <= step) {
                    now += samples[i];
                    before += luma_[i];
                    ++count;
                }
            gain = count * 4 >= columns * rows && before > 0 ? now * 4096 / before : 4096;
        }
        gain = std::abs(gain - 4096) < ExposurePass::min_gain_change ? 4096
                                                                     : std::clamp(gain, 3072, 5461);
    }
    luma_ = samples;
    return gain;
}

}  // namespace vantage

#include "rig_firmware/stereo/disparity/exposure_reference.h"

#include <algorithm>
#include <cstdlib>

namespace vantage {

int ExposureReference::gain_4096(const GreyImage& luma) {
    std::vector<int> samples;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
            samples.push_back(luma((2 * j + 1) * luma.rows / (2 * rows),
                                   (2 * i + 1) * luma.cols / (2 * columns)));
    int gain = 4096;
    if (!luma_.empty()) {
        for (const int step : {most_first_step, most_step}) {
            int now = 0, before = 0, count = 0;
            for (std::size_t i = 0; i < samples.size(); ++i)
                if (std::abs(samples[i] - ((luma_[i] * gain + 2048) >> 12)) <= step) {
                    now += samples[i];
                    before += luma_[i];
                    ++count;
                }
            gain = count * 4 >= columns * rows && before > 0 ? now * 4096 / before : 4096;
        }
        gain = std::abs(gain - 4096) < least_change ? 4096 : std::clamp(gain, 3072, 5461);
    }
    luma_ = samples;
    return gain;
}

}  // namespace vantage

#include "tests/references/stereo/stream_average.h"

#include <algorithm>
#include <cstdlib>

#include "rig_firmware/stereo/features/luma_pass.h"

namespace vantage {

StereoPlanes StreamAverage::run(const ColourImage& picture) {
    StereoPlanes planes = planes_of(picture);
    const int gain = exposure_.gain_4096(planes.luma);
    const bool is_first = frames_.empty();
    if (is_first) {
        luma_64_.create(picture.size());
        colour_64_.create(picture.size());
        frames_.create(picture.size());
    }
    const auto toward = [](int way, int part) { return (way + (1 << part) / 2) >> part; };
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x) {
            constexpr int white = 255 * 64, grey = 128 * 64;
            int &luma = luma_64_(y, x), &colour = colour_64_(y, x), &frames = frames_(y, x);
            if (!is_first) {
                luma = exposed(luma, gain, white);
                colour = std::clamp(exposed(colour - grey, gain, grey) + grey, 0, white);
            }
            const int to_luma = planes.luma(y, x) * 64 - luma,
                      to_colour = planes.colour(y, x) * 64 - colour;
            if (!is_first &&
                std::max(std::abs(to_luma), std::abs(to_colour)) <= LumaPass::max_noise * 64) {
                const int part = (frames + 2) / 2;
                luma += toward(to_luma, part);
                colour += toward(to_colour, part);
                frames = std::min(frames + 1, 4);
            } else {
                luma = planes.luma(y, x) * 64;
                colour = planes.colour(y, x) * 64;
                frames = 1;
            }
            planes.luma(y, x) = static_cast<unsigned char>((luma + 32) >> 6);
            planes.colour(y, x) = static_cast<unsigned char>((colour + 32) >> 6);
        }
    return planes;
}

}  // namespace vantage

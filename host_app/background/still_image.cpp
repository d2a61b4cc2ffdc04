#include "host_app/background/still_image.h"

#include <algorithm>
#include <vector>

#include "common/base/error.h"
#include "common/wire/codec/colour_codec.h"

namespace vantage {
namespace {

/// With fewer images a person who passes by could be in the result.
constexpr std::size_t min_pictures = 3;

/// The mean of the middle half of the values, which it sorts.
uchar middle_of(std::vector<uchar>& values) {
    std::sort(values.begin(), values.end());
    const std::size_t from = values.size() / 4, to = values.size() - from;
    std::size_t sum = 0;
    for (std::size_t i = from; i < to; ++i) sum += values[i];
    return static_cast<uchar>((sum + (to - from) / 2) / (to - from));
}

}  // namespace

ColourImage still_picture(std::span<const SharedBytes> jpegs, cv::Size size) {
    JpegDecoder decoder;
    std::vector<ColourImage> pictures;
    for (const SharedBytes& jpeg : jpegs) {
        try {
            pictures.push_back(decoder.decode(*jpeg, size.width, size.height));
        } catch (const Error&) {
            continue;
        }
    }
    if (pictures.size() < min_pictures) return {};
    ColourImage still(size);
    std::vector<uchar> values(pictures.size());
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            cv::Vec4b& pixel = still(y, x);
            for (int channel = 0; channel < 3; ++channel) {
                for (std::size_t i = 0; i < pictures.size(); ++i)
                    values[i] = pictures[i](y, x)[channel];
                pixel[channel] = middle_of(values);
            }
            pixel[3] = 255;
        }
    return still;
}

}  // namespace vantage

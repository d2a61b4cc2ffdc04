#include "common/wire/codec/disparity_codec.h"

#include <cstdint>

namespace vantage {
namespace {

std::uint16_t fold(std::uint16_t difference) {
    return static_cast<std::uint16_t>((difference << 1) ^ ((difference & 0x8000) ? 0xffff : 0));
}

std::uint16_t unfold(std::uint16_t folded) {
    return static_cast<std::uint16_t>((folded >> 1) ^ ((folded & 1) ? 0xffff : 0));
}

}  // namespace

std::vector<std::byte> DisparityEncoder::encode(const DisparityImage& disparity) {
    const std::size_t count = disparity.total();
    planes_.resize(2 * count);
    std::byte* low = planes_.data();
    std::byte* high = low + count;
    const std::vector<std::uint16_t> nothing_above(static_cast<std::size_t>(disparity.cols), 0);
    const std::uint16_t* above = nothing_above.data();
    for (int y = 0; y < disparity.rows; ++y) {
        const std::uint16_t* row = disparity[y];
        for (int x = 0; x < disparity.cols; ++x) {
            const std::uint16_t folded = fold(static_cast<std::uint16_t>(row[x] - above[x]));
            low[x] = static_cast<std::byte>(folded & 0xff);
            high[x] = static_cast<std::byte>(folded >> 8);
        }
        low += disparity.cols;
        high += disparity.cols;
        above = row;
    }
    return compressor_.compress(planes_);
}

DisparityImage DisparityDecoder::decode(std::span<const std::byte> payload, int width_px,
                                        int height_px) {
    const std::size_t count =
        static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
    const std::byte* low = decompressor_.decompress(payload, 2 * count, "disparity").data();
    const std::byte* high = low + count;
    auto disparity = pictures_.take<DisparityImage>({width_px, height_px});
    const std::vector<std::uint16_t> nothing_above(static_cast<std::size_t>(width_px), 0);
    const std::uint16_t* above = nothing_above.data();
    for (int y = 0; y < height_px; ++y) {
        std::uint16_t* row = disparity[y];
        for (int x = 0; x < width_px; ++x) {
            const auto folded = static_cast<std::uint16_t>(std::to_integer<unsigned>(low[x]) |
                                                           std::to_integer<unsigned>(high[x]) << 8);
            row[x] = static_cast<std::uint16_t>(above[x] + unfold(folded));
        }
        low += width_px;
        high += width_px;
        above = row;
    }
    return disparity;
}

}  // namespace vantage

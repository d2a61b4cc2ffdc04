#pragma once

#include <cstddef>

namespace vantage {

/// Shape of the engine's buffers for a picture size. Per-pixel buffers have rows of stride_px (a
/// multiple of 4, chosen so that the rows of a volume slab do not all start at the same place of a
/// cache page); luma buffers hold four pixels a word, one word of repeated edge before each row and
/// at least one behind.
struct StereoLayout {
    int width_px, height_px;

    int stride_px() const {
        const int stride = (width_px + 3) / 4 * 4;
        // A slab holds 32 bytes a pixel: rows that are near a multiple of 4096 bytes get pushed off
        // it.
        return stride % 128 < 4 || stride % 128 > 124 ? stride + 4 : stride;
    }
    int luma_row_words() const { return (width_px + 3) / 4 + 2; }
    std::size_t pixels() const {
        return static_cast<std::size_t>(stride_px()) * static_cast<std::size_t>(height_px);
    }
    std::size_t luma_words() const {
        return static_cast<std::size_t>(luma_row_words()) * static_cast<std::size_t>(height_px);
    }
};

/// Disparities that one slab of the cost volume holds; also how far the shaders are unrolled.
inline constexpr int slab_disparities = 16;

}  // namespace vantage

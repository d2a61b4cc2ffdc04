#pragma once

#include <cstddef>

namespace vantage {

/// Shape of the engine's buffers for a picture size. Per-pixel buffers have rows of stride_px (a
/// multiple of 4); luma buffers hold four pixels a word, one word of repeated edge before each row
/// and at least one behind; what columns are walked in lies in blocks of 16 pixels' width, row
/// under row, one block after the other (a walk down rows of a whole picture would miss the cache
/// at every step).
struct StereoLayout {
    static constexpr int block_px = 16;

    int width_px, height_px;

    int stride_px() const { return (width_px + 3) / 4 * 4; }
    int luma_row_words() const { return (width_px + 3) / 4 + 2; }
    std::size_t pixels() const {
        return static_cast<std::size_t>(stride_px()) * static_cast<std::size_t>(height_px);
    }
    /// Of a buffer in blocks.
    std::size_t block_pixels() const {
        return static_cast<std::size_t>((width_px + block_px - 1) / block_px * block_px) *
               static_cast<std::size_t>(height_px);
    }
    std::size_t block_at(int x, int y) const {
        return static_cast<std::size_t>((x / block_px * height_px + y) * block_px + x % block_px);
    }
    std::size_t luma_words() const {
        return static_cast<std::size_t>(luma_row_words()) * static_cast<std::size_t>(height_px);
    }
};

/// Disparities that one slab of the cost volume holds; also how far the shaders are unrolled.
inline constexpr int slab_disparities = 16;
constexpr int slabs_of(int disparities) {
    return (disparities + slab_disparities - 1) / slab_disparities;
}
constexpr int valid_in_last_slab(int disparities) {
    return (disparities - 1) % slab_disparities + 1;
}

}  // namespace vantage

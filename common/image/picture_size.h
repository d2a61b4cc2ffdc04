#pragma once

#include <cstdint>

#include "common/base/error.h"

namespace vantage {

inline constexpr int max_image_side_px = 16384;

/// Throws Error for a picture that no part of Vantage takes.
inline void require_picture_size(std::uint64_t width_px, std::uint64_t height_px) {
    if (width_px < 1 || height_px < 1 || width_px > max_image_side_px ||
        height_px > max_image_side_px)
        fail("it is {}x{}; pictures up to {} pixels a side are taken", width_px, height_px,
             max_image_side_px);
}

}  // namespace vantage

#pragma once

#include <cstdint>
#include <memory>

#include <opencv2/core.hpp>

#include "rig_firmware/capture/pixel_conversion.h"

namespace vantage {

/// Image that is still in its camera's buffer. The driver gets the buffer back when the last copy
/// of the lease is gone, and does not write to it before.
struct LentPicture {
    RawPicture raw;    ///< the whole buffer, mapped
    cv::Rect view;     ///< the visible part: the whole image, or one half of a side-by-side image
    int dma_buf = -1;  ///< the same memory for other drivers; -1 if it cannot be shared
    std::size_t offset = 0;  ///< offset of raw's first byte in the dma-buf
    /// Camera of the buffer: the same camera and index mean the same memory. Holding `camera` keeps
    /// another camera from getting its address.
    std::shared_ptr<const void> camera;
    unsigned index = 0;
    std::shared_ptr<const void> lease;
};

/// Converts the visible part to RGBA. Throws Error like to_colour() of a RawPicture.
ColourImage to_colour(const LentPicture& picture);

}  // namespace vantage

#pragma once

#include <cstdint>
#include <memory>

#include <opencv2/core.hpp>

#include "rig_firmware/capture/pixel_conversion.h"

namespace vantage {

/// A picture that still lies in its camera's buffer. The driver gets the buffer back when the last
/// copy of the lease is gone; until then it does not write there.
struct LentPicture {
    RawPicture raw;          ///< the whole buffer, mapped
    cv::Rect view;           ///< the part that is meant: all, or one half of both sides in one
    int dma_buf = -1;        ///< the same memory for other drivers; -1: cannot be shared
    std::size_t offset = 0;  ///< of raw's first byte in the dma-buf
    /// Which buffer: two of the same camera and index are the same memory. One who holds `camera`
    /// keeps its address from being another's.
    std::shared_ptr<const void> camera;
    unsigned index = 0;
    std::shared_ptr<const void> lease;
};

/// A copy of the part that is meant, as RGBA. Throws Error as to_colour of a RawPicture does.
ColourImage to_colour(const LentPicture& picture);

}  // namespace vantage

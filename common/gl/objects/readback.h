#pragma once

#include <optional>

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/fence.h"
#include "common/gl/objects/framebuffer.h"

namespace vantage {

/// Reads an image back from the GPU asynchronously, through a pixel buffer: begin() starts the
/// copy and take() returns it later, so that the caller can work meanwhile and never waits for
/// draws issued after begin(). One image at a time; the context that was current at the first
/// begin() must be current at every call.
class Readback {
  public:
    /// Copies the texture as it is after the commands issued so far.
    void begin(const Texture& texture);
    bool is_begun() const { return layout_.has_value(); }
    /// Waits for the copy, for at most `limit` (see Fence::wait). `pixels`: memory to reuse if its
    /// size and type match. Precondition: is_begun(), which is false afterwards.
    cv::Mat take(cv::Mat pixels = {}, std::chrono::nanoseconds limit = Fence::no_limit);

  private:
    std::optional<Buffer> buffer_;
    std::optional<PixelLayout> layout_;
    TextureFormat format_ = TextureFormat::rgba8;
    cv::Size size_;
    Fence fence_;
};

}  // namespace vantage

#pragma once

#include <optional>

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/fence.h"
#include "common/gl/objects/framebuffer.h"

namespace vantage {

/// A picture on its way back from the GPU, through a buffer of the driver's: begun at one time and
/// taken at another, so that neither waits for what was drawn later, and work is done meanwhile.
/// One picture at a time; the context that was current at the first begin() must be current at
/// every call.
class Readback {
  public:
    /// Of the texture as everything drawn so far leaves it; what is drawn later changes nothing.
    void begin(const Texture& texture);
    bool is_begun() const { return layout_.has_value(); }
    /// Waits until it is here, for at most `limit` (see Fence::wait). `pixels`: memory for it,
    /// where that has its size and type. Precondition: is_begun(), which it is not afterwards.
    cv::Mat take(cv::Mat pixels = {}, std::chrono::nanoseconds limit = Fence::no_limit);

  private:
    std::optional<Buffer> buffer_;
    std::optional<PixelLayout> layout_;
    TextureFormat format_ = TextureFormat::rgba8;
    cv::Size size_;
    Fence fence_;
};

}  // namespace vantage

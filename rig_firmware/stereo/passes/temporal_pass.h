#pragma once

#include <array>

#include "common/gl/framebuffer.h"
#include "common/gl/fullscreen_pass.h"
#include "common/gl/texture.h"

namespace vantage {

/// Steadies the disparities of a stream of pictures from one place: a running mean over frames
/// where picture and disparity stay as they were (it halves the standard deviation of what flickers
/// and more), the new value at once where either moves, so that a moving edge leaves no trail.
class TemporalPass {
  public:
    TemporalPass(const ShaderLibrary& library, int width_px, int height_px);

    /// disparity: r16ui as Matcher::match gives it; picture: rgba8, the left picture of the same
    /// frame. The result is like `disparity`, valid until the next call.
    const Texture& run(const Texture& disparity, const Texture& picture);

    /// The next frame starts anew.
    void forget() { has_state_ = false; }

    std::size_t gpu_bytes() const {
        return steadied_.bytes() + states_[0].bytes() + states_[1].bytes();
    }

  private:
    FullscreenPass pass_;
    Texture steadied_;
    std::array<Texture, 2> states_;
    std::array<Framebuffer, 2> targets_;
    std::size_t newest_ = 0;
    bool has_state_ = false;
};

}  // namespace vantage

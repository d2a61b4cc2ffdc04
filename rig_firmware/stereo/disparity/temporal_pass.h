#pragma once

#include <array>

#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"
#include "rig_firmware/stereo/features/exposure_pass.h"

namespace vantage {

/// Steadies the disparities of a stream of pictures from one place. Where the picture stays as it
/// was, a disparity is a running mean of those that agree with it (it halves the standard deviation
/// of what flickers and more) and is held against those that do not until more frames spoke against
/// it than for it; where the picture changes the new value counts at once, so that a moving edge
/// leaves no trail. An exposure that drifts, or leaps, is no change of the picture.
class TemporalPass {
  public:
    /// Largest change of a still pixel: the sum over the five pixels of a cross of the differences
    /// from their running means, in grey levels. A sensor noise of 2 grey levels makes 6.
    static constexpr int max_still_change = 40;
    /// Likewise, where the mean is kept although the new disparity differs from it.
    static constexpr int max_holding_change = 20;
    /// Largest difference of consistent disparities, in 1/1024 px.
    static constexpr int max_consistent_step = 1536;
    /// A pixel's score: what a consistent frame adds (an inconsistent one subtracts 1), the score
    /// of a disparity that has just replaced another one, and the largest score.
    static constexpr int consistent_score = 2, first_score = 4, max_score = 15;

    TemporalPass(const ShaderLibrary& library, int width_px, int height_px);

    /// disparity: r16ui as Matcher::match gives it; picture: rgba8, the left picture of the same
    /// frame. The result is like `disparity`, valid until the next call.
    const Texture& run(const Texture& disparity, const Texture& picture);

    /// The next frame starts anew.
    void forget() { has_state_ = false; }

    std::size_t gpu_bytes() const {
        return denoised_.bytes() + states_[0].bytes() + states_[1].bytes();
    }

  private:
    ExposurePass exposure_;
    FullscreenPass pass_;
    Texture denoised_;
    std::array<Texture, 2> states_;
    std::array<Framebuffer, 2> targets_;
    std::size_t newest_ = 0;
    bool has_state_ = false;
};

}  // namespace vantage

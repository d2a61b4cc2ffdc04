#pragma once

#include <optional>

#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/buffer.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/program.h"
#include "common/gl/objects/texture.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// How a pass leaves a disparity per pixel in a buffer.
enum class DisparityForm {
    words,   ///< LeftRightPass's: 32 bits with the confidence
    halves,  ///< 16 bits without it
};
inline std::size_t bytes_per_disparity(DisparityForm form) {
    return form == DisparityForm::words ? 4 : 2;
}

/// From a buffer into the textures that a matcher gives back.
class ResultPass {
  public:
    ResultPass(const ShaderLibrary& library, const StereoLayout& layout,
               bool with_confidence = false, DisparityForm form = DisparityForm::words);

    /// r16ui, see Matcher::match.
    const Texture& run(PassProfiler& profiler, const Buffer& disparity);
    /// r8ui of the last run, null unless asked for.
    const Texture* confidence() const { return confidence_ ? &*confidence_ : nullptr; }

    std::size_t gpu_bytes() const {
        return result_.bytes() + (confidence_ ? confidence_->bytes() : 0U);
    }

  private:
    StereoLayout layout_;
    DisparityForm form_;
    FullscreenPass pass_;
    Texture result_;
    std::optional<Texture> confidence_;
    Framebuffer target_;
};

}  // namespace vantage

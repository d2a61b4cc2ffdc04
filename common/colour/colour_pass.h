#pragma once

#include <optional>

#include "common/colour/colour_correction.h"
#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"
#include "common/gl/shader_library.h"

namespace vantage {

/// Applies a ColourCorrection on the GPU. The context that was current at construction must be
/// current at every call; `library` must outlive the pass.
class ColourPass {
  public:
    explicit ColourPass(const ShaderLibrary& library);

    /// Draws the corrected frame into `target`. Both textures are rgba8 and of the same size.
    void correct(const Texture& camera, const ColourCorrection& correction,
                 const Framebuffer& target);

  private:
    FullscreenPass pass_;
};

/// Uploads the frames of one camera and corrects their colours on the GPU, into a texture. The
/// context that was current at construction must be current at every call.
class ColourCorrector {
  public:
    ColourCorrector() : pass_(library_) {}

    /// `stage` is rgba8 and of the frame's size; only its first mip level is written.
    void upload(const ColourImage& picture, const ColourCorrection& correction,
                const Texture& stage);

  private:
    ShaderLibrary library_;
    ColourPass pass_;
    std::optional<Texture> camera_;
};

}  // namespace vantage

#pragma once

#include "common/colour/colour_pass.h"
#include "common/gl/shader_library.h"

namespace vantage {

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

#pragma once

#include "common/colour/colour_pass.h"
#include "common/gl/shader_library.h"

namespace vantage {

/// Uploads pictures of one camera and corrects them on the GPU on their way into a texture. The
/// context that was current at construction must be current at every call.
class ColourCorrector {
  public:
    ColourCorrector() : pass_(library_) {}

    /// `stage`: rgba8, of the picture's size; its first level is written.
    void upload(const ColourImage& picture, const ColourCorrection& correction,
                const Texture& stage);

  private:
    ShaderLibrary library_;
    ColourPass pass_;
    std::optional<Texture> camera_;
};

}  // namespace vantage

#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"

namespace vantage {

/// Fills the pixels that no rig saw by pull and push (Gortler et al., 1996): the image is halved
/// repeatedly, averaging the known pixels, and holes take their colour from the coarser images. A
/// hole most likely shows the farther surface, so only the farther pixels of each neighbourhood are
/// averaged. Belongs to one context.
class HoleFiller {
  public:
    explicit HoleFiller(const ShaderLibrary& library);

    /// `colour` is rgba8 with alpha 0 in holes; `depth_m` is its depth, r32f. Returns an rgba8
    /// image, valid until the next call. Its alpha is unchanged in known pixels, 64/255 in filled
    /// ones and 0 everywhere if no pixel was known.
    const Texture& fill(const Texture& colour, const Texture& depth_m);

  private:
    struct Level {
        Texture colour, depth_m;
        Framebuffer target;
        Texture filled;
        Framebuffer filled_target;
        explicit Level(cv::Size size);
    };
    void resize(cv::Size size);

    FullscreenPass pull_, push_;
    std::vector<std::unique_ptr<Level>> levels_;  ///< the first has half the image's size
    std::optional<Texture> filled_;
    std::optional<Framebuffer> filled_target_;
};

}  // namespace vantage

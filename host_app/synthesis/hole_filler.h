#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"

namespace vantage {

/// Fills what nobody saw, by pull and push (Gortler et al., 1996): the picture is halved again and
/// again, averaging what is known, and the holes take their colour from the coarser pictures. What
/// is behind a hole is more likely than what stands before it, so only the farther part of each
/// neighbourhood is averaged.
class HoleFiller {
  public:
    explicit HoleFiller(const ShaderLibrary& library);

    /// `colour` is rgba8 with alpha 0 in holes; `depth_m` its r32f depth. The result is rgba8:
    /// alpha as given where the picture was known, 64/255 where it was filled, 0 where nothing at
    /// all was known. Valid until the next call.
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
    std::vector<std::unique_ptr<Level>> levels_;  ///< the first is half the picture's size
    std::optional<Texture> filled_;
    std::optional<Framebuffer> filled_target_;
};

}  // namespace vantage

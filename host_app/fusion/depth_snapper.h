#pragma once

#include "common/gl/framebuffer.h"
#include "common/gl/fullscreen_pass.h"
#include "host_app/fusion/drawn_texture.h"

namespace vantage {

/// Moves the depth edges of a rig's depth map to the edges of its colour picture.
class DepthSnapper {
  public:
    explicit DepthSnapper(const ShaderLibrary& library);

    /// `depth_m`: r32f, 0 = unknown, negative = guessed; the same form into `snapped`.
    void snap(const Texture& depth_m, const Texture& colour, const Framebuffer& snapped);

  private:
    FullscreenPass range_, snap_;
    DrawnTexture near_far_;
};

}  // namespace vantage

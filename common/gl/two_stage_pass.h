#pragma once

#include <functional>

#include "common/gl/fullscreen_pass.h"

namespace vantage {

/// Two fragment shaders over one target with a depth texture: the first draws every pixel and says
/// which of them it leaves to the second, which runs for those alone. A software rasteriser takes
/// both sides of a branch for every pixel; what fails the depth test it skips.
class TwoStagePass {
  public:
    /// The stages are the same shader with FIRST defined as 1 and as 0; it includes
    /// two_stages.glsl, and its first stage calls leave_to_second() for every pixel.
    TwoStagePass(const ShaderLibrary& library, const std::string& fragment,
                 const ShaderDefines& defines = {});

    /// `set` is called for either stage, whose program is in use and ready for uniforms.
    void draw(const Framebuffer& target, const std::function<void(Program&)>& set);

    /// The second stage alone, of a pass whose first one was drawn: the program is in use.
    static void draw_left(FullscreenPass& second, const Framebuffer& target);

  private:
    FullscreenPass first_, second_;
};

}  // namespace vantage

#pragma once

#include <functional>

#include "common/gl/fullscreen_pass.h"

namespace vantage {

/// Two fragment shaders over one target with a depth texture. The first draws every pixel and marks
/// those that need the second, which then runs for those alone. A software rasteriser evaluates
/// both sides of a branch for every pixel, but skips pixels that fail the depth test.
class TwoStagePass {
  public:
    /// Both stages are the same shader, with FIRST defined as 1 and 0. It includes two_stages.glsl,
    /// and its first stage calls leave_to_second() for each pixel.
    TwoStagePass(const ShaderLibrary& library, const std::string& fragment,
                 const ShaderDefines& defines = {});

    /// Calls `set` for either stage, with its program in use and ready for uniforms.
    void draw(const Framebuffer& target, const std::function<void(Program&)>& set);

    /// Draws the second stage alone, after the first was drawn. Its program is in use.
    static void draw_left(FullscreenPass& second, const Framebuffer& target);

  private:
    FullscreenPass first_, second_;
};

}  // namespace vantage

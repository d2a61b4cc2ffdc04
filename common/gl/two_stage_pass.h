#pragma once

#include <functional>

#include "common/gl/fullscreen_pass.h"

namespace vantage {

/// Two fragment shaders over one target with a depth texture. The first draws every pixel and marks
/// in the depth texture those that it leaves to the second, which runs for these alone. A software
/// rasteriser executes both sides of a branch for every pixel, but skips pixels that fail the depth
/// test.
class TwoStagePass {
  public:
    /// Both stages are compiled from one shader, with FIRST defined as 1 and as 0. It includes
    /// two_stages.glsl; its first stage calls leave_to_second() for every pixel.
    TwoStagePass(const ShaderLibrary& library, const std::string& fragment,
                 const ShaderDefines& defines = {});

    /// Calls `set` for each stage to give its program, which is in use, inputs and uniforms.
    void draw(const Framebuffer& target, const std::function<void(Program&)>& set);

    /// Draws only the second stage, after its first was drawn; its program must be in use.
    static void draw_left(FullscreenPass& second, const Framebuffer& target);

  private:
    FullscreenPass first_, second_;
};

}  // namespace vantage

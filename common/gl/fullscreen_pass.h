#pragma once

#include "common/gl/framebuffer.h"
#include "common/gl/program.h"
#include "common/gl/vertex_array.h"

namespace vantage {

/// Runs a fragment shader once for every pixel of a framebuffer, with shaders/fullscreen.vert. Row
/// 0 of the target is the top of the picture, as in memory: gl_FragCoord.xy - 0.5 is the pixel's
/// (x, y).
class FullscreenPass {
  public:
    FullscreenPass(const ShaderLibrary& library, std::string fragment, ShaderDefines defines = {});

    /// The program, in use and ready for uniforms.
    Program& use();
    /// Draws with the program in use; depth test, blending and culling off.
    void draw(const Framebuffer& target);

  private:
    Program program_;
    VertexArray vertices_;
};

}  // namespace vantage

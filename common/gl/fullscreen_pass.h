#pragma once

#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/program.h"
#include "common/gl/objects/vertex_array.h"

namespace vantage {

/// Runs a fragment shader once for every pixel of a framebuffer, with
/// shaders/shared/fullscreen.vert. If the thread has a SlicedDrawing, the target is drawn in bands.
/// Row 0 of the target is the top of the picture, as in memory: gl_FragCoord.xy - 0.5 is the
/// pixel's (x, y).
class FullscreenPass {
  public:
    FullscreenPass(const ShaderLibrary& library, std::string fragment, ShaderDefines defines = {});

    /// The program, in use and ready for inputs and uniforms.
    Program& use();
    /// Draws with the program in use, without depth test, blending and culling.
    void draw(const Framebuffer& target);
    /// Like draw(), with a shader that writes every pixel of the target. The old contents are
    /// discarded first, so that GPUs that draw in tiles (a Raspberry Pi's) need not read them.
    void overwrite(const Framebuffer& target);
    /// Draws with a shader that writes gl_FragDepth into the target's depth texture.
    void draw_depth(const Framebuffer& target);
    /// Draws only the pixels where `depth` passes `comparison` (GL_LESS, GL_GREATER, ...) with the
    /// target's depth texture; the shader does not run for the others. With `writes`, stores
    /// `depth` there unless the shader discards the pixel.
    void draw_where(const Framebuffer& target, GLenum comparison, float depth, bool writes);

  private:
    void draw_triangle(const Framebuffer& target);

    Program program_;
    VertexArray vertices_;
    int slice_rows_ = 0;
};

}  // namespace vantage

#pragma once

#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/program.h"
#include "common/gl/objects/vertex_array.h"

namespace vantage {

/// Runs a fragment shader once for every pixel of a framebuffer, with
/// shaders/shared/fullscreen.vert; in bands where the thread has a SlicedDrawing. Row 0 of the
/// target is the top of the picture, as in memory: gl_FragCoord.xy - 0.5 is the pixel's (x, y).
class FullscreenPass {
  public:
    FullscreenPass(const ShaderLibrary& library, std::string fragment, ShaderDefines defines = {});

    /// The program, in use and ready for uniforms.
    Program& use();
    /// Draws with the program in use; depth test, blending and culling off.
    void draw(const Framebuffer& target);
    /// The same for a shader that writes every pixel of the target: the old contents are discarded
    /// first, which spares GPUs that draw in tiles (a Raspberry Pi's) reading them.
    void overwrite(const Framebuffer& target);
    /// The same with a shader that writes gl_FragDepth into the target's depth texture.
    void draw_depth(const Framebuffer& target);
    /// Draws only those pixels where `depth` compares so (GL_LESS, GL_GREATER, ...) with the
    /// target's depth texture, and, with `writes`, puts it there unless the shader discards the
    /// pixel: a shader that only some pixels need runs for no others.
    void draw_where(const Framebuffer& target, GLenum comparison, float depth, bool writes);

  private:
    void draw_triangle(const Framebuffer& target);

    Program program_;
    VertexArray vertices_;
    int slice_rows_ = 0;
};

}  // namespace vantage

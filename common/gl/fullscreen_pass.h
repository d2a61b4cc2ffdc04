#pragma once

#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/program.h"
#include "common/gl/objects/vertex_array.h"

namespace vantage {

/// Runs a fragment shader once per pixel of a framebuffer, with shaders/shared/fullscreen.vert; in
/// bands if the thread has a SlicedDrawing. Row 0 of the target is the top of the image, as in
/// memory: gl_FragCoord.xy - 0.5 is the pixel's (x, y).
class FullscreenPass {
  public:
    FullscreenPass(const ShaderLibrary& library, std::string fragment, ShaderDefines defines = {});

    /// The program, in use and ready for uniforms.
    Program& use();
    /// Draws with the program in use; depth test, blending and culling off.
    void draw(const Framebuffer& target);
    /// Draws with a shader that writes gl_FragDepth into the target's depth texture.
    void draw_depth(const Framebuffer& target);
    /// Draws only the pixels whose value in the target's depth texture compares with `depth`
    /// (GL_LESS, GL_GREATER, ...). With `writes`, stores `depth` for each pixel that the shader
    /// does not discard. Saves an expensive shader on pixels that do not need it.
    void draw_where(const Framebuffer& target, GLenum comparison, float depth, bool writes);

  private:
    void draw_triangle(const Framebuffer& target);

    Program program_;
    VertexArray vertices_;
    int slice_rows_ = 0;
};

}  // namespace vantage

#include "common/gl/fullscreen_pass.h"

#include "common/gl/sliced_drawing.h"

namespace vantage {

FullscreenPass::FullscreenPass(const ShaderLibrary& library, std::string fragment,
                               ShaderDefines defines)
    : program_(
          Program::render(library, "fullscreen.vert", std::move(fragment), std::move(defines))) {}

Program& FullscreenPass::use() {
    program_.use();
    return program_;
}

void FullscreenPass::draw(const Framebuffer& target) {
    glDisable(GL_DEPTH_TEST);
    draw_triangle(target);
}

void FullscreenPass::overwrite(const Framebuffer& target) {
    target.discard_colours();
    draw(target);
}

void FullscreenPass::draw_depth(const Framebuffer& target) {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glDepthMask(GL_TRUE);
    draw_triangle(target);
    glDisable(GL_DEPTH_TEST);
}

void FullscreenPass::draw_where(const Framebuffer& target, GLenum comparison, float depth,
                                bool writes) {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(comparison);
    glDepthMask(writes ? GL_TRUE : GL_FALSE);
    glDepthRangef(depth, depth);
    draw_triangle(target);
    glDepthRangef(0, 1);
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);
}

void FullscreenPass::draw_triangle(const Framebuffer& target) {
    target.bind();
    vertices_.bind();
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    const auto draw = [] { glDrawArrays(GL_TRIANGLES, 0, 3); };
    if (const SlicedDrawing* slices = SlicedDrawing::current())
        slices->draw(target.size(), slice_rows_, draw);
    else
        draw();
}

}  // namespace vantage

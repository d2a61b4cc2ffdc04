#include "common/gl/fullscreen_pass.h"

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
    target.bind();
    vertices_.bind();
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace vantage

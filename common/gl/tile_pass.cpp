#include "common/gl/tile_pass.h"

#include "common/gl/sliced_drawing.h"

namespace vantage {

TilePass::TilePass(const ShaderLibrary& library, std::string fragment, ShaderDefines defines)
    : program_(Program::render(library, "tiles.vert", std::move(fragment), std::move(defines))) {}

Program& TilePass::use() {
    program_.use();
    return program_;
}

void TilePass::draw(const Framebuffer& target, const Texture& tiles, cv::Size picture) {
    constexpr int corners_per_tile = 6;
    program_.set("tile_share", share_of(picture));
    program_.input("tiles", tiles);
    target.bind();
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT);
    vertices_.bind();
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    const auto draw = [&] {
        glDrawArrays(GL_TRIANGLES, 0, corners_per_tile * tiles.width_px() * tiles.height_px());
    };
    if (const SlicedDrawing* slices = SlicedDrawing::current())
        slices->draw(target.size(), slice_rows_, draw);
    else
        draw();
}

}  // namespace vantage

#include "host_app/refine/depth_inpainting.h"

namespace vantage {
namespace {

/// The pyramid closes holes up to about 2^halvings pixels wide.
constexpr std::size_t halvings = 6;

}  // namespace

DepthInpainting::DepthInpainting(const ShaderLibrary& library)
    : inpaint_(library, "depth_inpaint.frag"),
      pull_(library, "depth_pull.frag"),
      push_(library, "depth_push.frag") {}

DepthInpainting::Pyramid& DepthInpainting::pyramid(cv::Size size) {
    Pyramid& pyramid = pyramids_[{size.width, size.height}];
    pyramid.inpainted.resize(size);
    while (pyramid.levels.size() < halvings) {
        size = {(size.width + 1) / 2, (size.height + 1) / 2};
        Level& level = pyramid.levels.emplace_back();
        level.pulled.resize(size);
        level.pushed.resize(size);
    }
    return pyramid;
}

void DepthInpainting::close(const Texture& depth_m, const Texture& measured_m,
                            const Texture& picture, const Framebuffer& closed) {
    const Pyramid& pyramid = this->pyramid(depth_m.size());
    const std::vector<Level>& levels = pyramid.levels;
    Program& inpaint = inpaint_.use();
    inpaint.input("depth_map", depth_m);
    inpaint.input("measured", measured_m);
    inpaint.input("picture", picture);
    inpaint_.draw(pyramid.inpainted.target());
    const Texture& inpainted = pyramid.inpainted.texture();
    const Texture* fine = &inpainted;
    for (const Level& level : levels) {
        pull_.use().input("depth_map", *fine);
        pull_.draw(level.pulled.target());
        fine = &level.pulled.texture();
    }
    const Texture* coarse = fine;
    for (std::size_t i = levels.size(); i-- > 0;) {
        Program& program = push_.use();
        program.input("depth_map", i == 0 ? inpainted : levels[i - 1].pulled.texture());
        program.input("coarse", *coarse);
        push_.draw(i == 0 ? closed : levels[i - 1].pushed.target());
        if (i > 0) coarse = &levels[i - 1].pushed.texture();
    }
}

}  // namespace vantage

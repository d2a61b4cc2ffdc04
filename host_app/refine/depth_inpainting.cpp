#include "host_app/refine/depth_inpainting.h"

#include "host_app/views/depth_edges.h"

namespace vantage {
namespace {

/// Holes up to about 2^halvings pixels wide are closed.
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

void DepthInpainting::close(const Texture& depth_m, const Texture& measured_m, const Texture& picture,
                        const Framebuffer& closed) {
    const Pyramid& pyramid = this->pyramid(depth_m.size());
    const std::vector<Level>& levels = pyramid.levels;
    Program& inpaint = inpaint_.use();
    inpaint.set("depth_map", 0);
    inpaint.set("measured", 1);
    inpaint.set("picture", 2);
    inpaint.set("edge_ratio", depth_edge_ratio);
    depth_m.bind(0);
    measured_m.bind(1);
    picture.bind(2);
    inpaint_.draw(pyramid.inpainted.target());
    const Texture& inpainted = pyramid.inpainted.texture();
    const Texture* fine = &inpainted;
    for (const Level& level : levels) {
        pull_.use().set("depth_map", 0);
        fine->bind(0);
        pull_.draw(level.pulled.target());
        fine = &level.pulled.texture();
    }
    const Texture* coarse = fine;
    for (std::size_t i = levels.size(); i-- > 0;) {
        Program& program = push_.use();
        program.set("depth_map", 0);
        program.set("coarse", 1);
        (i == 0 ? inpainted : levels[i - 1].pulled.texture()).bind(0);
        coarse->bind(1);
        push_.draw(i == 0 ? closed : levels[i - 1].pushed.target());
        if (i > 0) coarse = &levels[i - 1].pushed.texture();
    }
}

}  // namespace vantage

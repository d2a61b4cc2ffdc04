#include "host_app/fusion/depth_closer.h"

namespace vantage {
namespace {

/// Holes up to about 2^halvings pixels wide are closed.
constexpr std::size_t halvings = 6;

}  // namespace

DepthCloser::DepthCloser(const ShaderLibrary& library)
    : pull_(library, "depth_pull.frag"), push_(library, "depth_push.frag") {}

DepthCloser::Pyramid& DepthCloser::pyramid(cv::Size size) {
    Pyramid& pyramid = pyramids_[{size.width, size.height}];
    while (pyramid.size() < halvings) {
        size = {(size.width + 1) / 2, (size.height + 1) / 2};
        Level& level = pyramid.emplace_back();
        level.pulled.resize(size);
        level.pushed.resize(size);
    }
    return pyramid;
}

void DepthCloser::close(const Texture& depth_m, const Framebuffer& closed) {
    const Pyramid& levels = pyramid(depth_m.size());
    const Texture* fine = &depth_m;
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
        (i == 0 ? depth_m : levels[i - 1].pulled.texture()).bind(0);
        coarse->bind(1);
        push_.draw(i == 0 ? closed : levels[i - 1].pushed.target());
        if (i > 0) coarse = &levels[i - 1].pushed.texture();
    }
}

}  // namespace vantage

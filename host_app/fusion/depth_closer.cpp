#include "host_app/fusion/depth_closer.h"

namespace vantage {
namespace {

/// Holes up to about 2^halvings pixels wide are closed.
constexpr int halvings = 6;

}  // namespace

DepthCloser::DepthCloser(const ShaderLibrary& library)
    : pull_(library, "depth_pull.frag"), push_(library, "depth_push.frag") {}

DepthCloser::Pyramid& DepthCloser::pyramid(cv::Size size) {
    Pyramid& pyramid = pyramids_[{size.width, size.height}];
    if (!pyramid.empty()) return pyramid;
    for (int i = 0; i <= halvings; ++i) {
        Level& level = pyramid.emplace_back();
        if (i > 0) level.pulled.resize(size);
        if (i < halvings) level.pushed.resize(size);
        size = {(size.width + 1) / 2, (size.height + 1) / 2};
    }
    return pyramid;
}

const Texture& DepthCloser::close(const Texture& depth_m) {
    Pyramid& levels = pyramid(depth_m.size());
    const auto pulled = [&](std::size_t i) -> const Texture& {
        return i == 0 ? depth_m : levels[i].pulled.texture();
    };
    for (std::size_t i = 1; i < levels.size(); ++i) {
        pull_.use().set("depth_map", 0);
        pulled(i - 1).bind(0);
        pull_.draw(levels[i].pulled.target());
    }
    const Texture* coarse = &pulled(levels.size() - 1);
    for (std::size_t i = levels.size() - 1; i-- > 0;) {
        Program& program = push_.use();
        program.set("depth_map", 0);
        program.set("coarse", 1);
        pulled(i).bind(0);
        coarse->bind(1);
        push_.draw(levels[i].pushed.target());
        coarse = &levels[i].pushed.texture();
    }
    return *coarse;
}

}  // namespace vantage

#include "host_app/refine/depth_inpainting.h"

namespace vantage {
namespace {

/// The pyramid closes holes up to about 2^halvings pixels wide.
constexpr std::size_t halvings = 6;

}  // namespace

DepthInpainting::DepthInpainting(const ShaderLibrary& library)
    : inpaint_(library, "depth_inpaint.frag"), fill_(library, PullPush::Kind::depth) {}

void DepthInpainting::close(const Texture& depth_m, const Texture& measured_m,
                            const Texture& picture, const Framebuffer& closed) {
    const cv::Size size = depth_m.size();
    Sized& sized = sized_[{size.width, size.height}];
    sized.inpainted.resize(size);
    sized.pyramid.resize(PullPush::Kind::depth, size, halvings);
    Program& inpaint = inpaint_.use();
    inpaint.input("depth_map", depth_m);
    inpaint.input("measured", measured_m);
    inpaint.input("picture", picture);
    inpaint_.draw(sized.inpainted.target());
    const Texture& inpainted = sized.inpainted.texture();
    fill_.fill(inpainted, inpainted, sized.pyramid, closed);
}

}  // namespace vantage

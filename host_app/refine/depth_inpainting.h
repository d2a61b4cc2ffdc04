#pragma once

#include <map>
#include <utility>

#include "common/gl/fullscreen_pass.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/surfaces/pull_push.h"

namespace vantage {

/// Depth inpainting: gives depth to pixels of a rig that have none, so that their colour can be
/// shown where no rig has measured the place. The depth comes from the nearest known pixels of
/// similar colour, the farther side's first: a place that a stereo rig cannot match is mostly
/// background that only one of its cameras sees. Where none is near it comes from pull and push.
class DepthInpainting {
  public:
    explicit DepthInpainting(const ShaderLibrary& library)
        : inpaint_(library, "depth_inpaint.frag"), fill_(library, PullPush::Kind::depth) {}

    /// Draws into `closed` (r32f, the size of `depth_m`) the known depth and, with a negative sign,
    /// the inpainted depth.
    ///
    /// @param depth_m r32f, metres, 0 = unknown; negative (inpainted before) is kept
    /// @param measured_m the depth before other rigs carved some of it away; where it has any, none
    ///     is taken from pixels beside
    /// @param picture the rig's colours
    void close(const Texture& depth_m, const Texture& measured_m, const Texture& picture,
               const Framebuffer& closed) {
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

  private:
    /// The pyramid closes holes up to about 2^halvings pixels wide.
    static constexpr std::size_t halvings = 6;

    struct Sized {
        DrawnTexture inpainted{TextureFormat::r32f};
        PullPush::Pyramid pyramid;
    };

    FullscreenPass inpaint_;
    PullPush fill_;
    std::map<std::pair<int, int>, Sized> sized_;  ///< by size; rigs of one size share one
};

}  // namespace vantage

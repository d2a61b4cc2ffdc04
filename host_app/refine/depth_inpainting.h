#pragma once

#include <map>
#include <vector>

#include "common/gl/fullscreen_pass.h"
#include "host_app/surfaces/drawn_texture.h"

namespace vantage {

/// Guesses the depth of a rig's pixels that have none, so that their colour can be shown where no
/// rig knows better: from the nearest known pixels of like colour, the farther side's first, for
/// what a stereo rig cannot match is mostly background that one of its two cameras does not see;
/// where none is near, by pull and push on inverse depth.
class DepthInpainting {
  public:
    explicit DepthInpainting(const ShaderLibrary& library);

    /// `depth_m`: r32f, 0 = unknown, negative = guessed, and left so; `measured_m`: before other
    /// rigs carved some of it away; `picture`: the same rig's.
    /// Into `closed`, r32f of the same size: what was known, and the guesses with a negative sign.
    void close(const Texture& depth_m, const Texture& measured_m, const Texture& picture,
               const Framebuffer& closed);

  private:
    /// The first level is of half the map's size, every next one of half the last one's.
    struct Level {
        DrawnTexture pulled{TextureFormat::r32f}, pushed{TextureFormat::r32f};
    };
    struct Pyramid {
        DrawnTexture inpainted{TextureFormat::r32f};
        std::vector<Level> levels;
    };
    Pyramid& pyramid(cv::Size size);

    FullscreenPass inpaint_, pull_, push_;
    std::map<std::pair<int, int>, Pyramid> pyramids_;  ///< by size; rigs of one size share theirs
};

}  // namespace vantage

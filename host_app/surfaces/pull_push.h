#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "common/gl/fullscreen_pass.h"
#include "host_app/surfaces/drawn_texture.h"

namespace vantage {

/// Fills holes by pull and push (Gortler et al., "The lumigraph", 1996): an image is halved
/// repeatedly, averaging the known pixels, and holes take their values from the coarser images. A
/// hole most likely shows the farther surface, so only the farther pixels of each neighbourhood are
/// averaged. Belongs to one context.
class PullPush {
  public:
    /// The kind of image that is filled. Colour (rgba8, alpha 0 in holes) comes with its depth.
    /// Depth (r32f, metres, 0 in holes) is averaged as inverse depth over a wider neighbourhood,
    /// and filled with a negative sign.
    enum class Kind { colour, depth };

    /// The halved images of one size, the largest first.
    class Pyramid {
      public:
        /// Keeps what there is if the size is the same. The number of halvings limits the width of
        /// a hole that is filled to about 2^halvings pixels.
        void resize(Kind kind, cv::Size size, std::size_t max_halvings);

      private:
        friend class PullPush;
        struct Level;
        std::vector<std::shared_ptr<Level>> levels_;
        cv::Size size_;
    };

    PullPush(const ShaderLibrary& library, Kind kind);

    /// Fills the holes of `image` into `filled`, both of the pyramid's size. `depth_m` is the depth
    /// of a colour image; of a depth image, the image itself.
    void fill(const Texture& image, const Texture& depth_m, const Pyramid& pyramid,
              const Framebuffer& filled);

  private:
    FullscreenPass pull_, push_;
};

/// Fills the pixels of a rendered frame that no rig saw. Belongs to one context.
class HoleFiller {
  public:
    explicit HoleFiller(const ShaderLibrary& library) : fill_(library, PullPush::Kind::colour) {}

    /// `colour` is rgba8 with alpha 0 in holes; `depth_m` is its depth, r32f. Returns an rgba8
    /// image, valid until the next call. Its alpha is unchanged in known pixels, 64/255 in filled
    /// ones and 0 everywhere if no pixel was known.
    const Texture& fill(const Texture& colour, const Texture& depth_m);

  private:
    PullPush fill_;
    PullPush::Pyramid pyramid_;
    DrawnTexture filled_{TextureFormat::rgba8, Filter::linear};
};

}  // namespace vantage

#pragma once

#include <span>

#include "host_app/surfaces/drawn_texture.h"
#include "host_app/synthesis/rig_layers.h"

namespace vantage {

/// Composites the rigs' foreground over the background in a virtual view. The mattes decide where
/// the foreground ends. Belongs to one context.
class ForegroundLayers {
  public:
    explicit ForegroundLayers(const ShaderLibrary& library);

    /// `picture` and `depth_m` are the background's, in the target's size; `shares` are the rigs'
    /// shares in it, or null if they are not recorded. `performers` are the boundary layers
    /// (InstantRig::boundary) of the same rigs in the same order. `is_plain` costs less and is no
    /// sharper than bilinear sampling. The result is valid until the next call.
    const DepthPicture& show(const Texture& picture, const Texture& depth_m, const Texture* shares,
                             std::span<const DrawnLayer> performers, const VirtualView& target,
                             bool is_plain);

    /// The foreground without a background's picture, plainly: its colours are premultiplied by
    /// alpha, and depth is 0 where nothing stands. `background_m` hides what stands behind it.
    const DepthPicture& show_alone(const Texture& background_m, bool notes_shares,
                                   std::span<const DrawnLayer> performers,
                                   const VirtualView& target);

  private:
    const DepthPicture& show(LayerPass& find, LayerPass& show, const Texture* picture,
                             const Texture& depth_m, bool has_shares, const Texture* shares,
                             std::span<const DrawnLayer> performers, const VirtualView& target);

    RigLayers layers_;
    LayerPass find_, show_, show_plainly_, find_alone_, show_alone_;
    DepthPicture shown_;
    DrawnDepth open_;
};

}  // namespace vantage

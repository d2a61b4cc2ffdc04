#pragma once

#include <span>

#include "host_app/surfaces/depth_picture.h"
#include "host_app/synthesis/layer_pass.h"
#include "host_app/synthesis/rig_layers.h"

namespace vantage {

/// Puts the performers of rigs before the set in a virtual view. Where they end their mattes say.
class ForegroundLayers {
  public:
    explicit ForegroundLayers(const ShaderLibrary& library);

    /// `picture` and `depth_m` are the set's, of the target's size; `shares` are the rigs' in it,
    /// or null where they are not noted. `performers`, of the same rigs in the same order, are what
    /// InstantRig::boundary says. `is_plain`: at less cost, no sharper than bilinear. The result is
    /// valid until the next call.
    const DepthPicture& show(const Texture& picture, const Texture& depth_m, const Texture* shares,
                             std::span<const DrawnLayer> performers, const VirtualView& target,
                             bool is_plain);

  private:
    RigLayers layers_;
    LayerPass find_, show_, show_plainly_;
    DepthPicture shown_;
    DrawnDepth open_;
};

}  // namespace vantage

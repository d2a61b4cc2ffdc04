#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/gl/buffer.h"
#include "common/gl/fullscreen_pass.h"
#include "host_app/instants/depth_picture.h"
#include "host_app/instants/drawn_texture.h"
#include "host_app/synthesis/mesh_rasteriser.h"
#include "host_app/synthesis/rig_layers.h"

namespace vantage {

/// Shows the rigs' background plates where no rig sees anything now: what a performer uncovers for
/// the virtual camera but hides from every rig.
class BackgroundPlates {
  public:
    static constexpr std::size_t most_shown = 2;

    explicit BackgroundPlates(const ShaderLibrary& library);

    /// `picture` with what the plates of up to `most` of the layers' rigs, and of no more than
    /// most_shown, remember where its alpha is below a half; remembered_alpha there. Valid until
    /// the next call.
    const DepthPicture& show(const DepthPicture& picture, const RigLayers& layers,
                             const VirtualView& target, std::size_t most = most_shown);

  private:
    FullscreenPass& pass(std::size_t layers);

    const ShaderLibrary* library_;
    MeshRasteriser rasteriser_;
    std::array<std::optional<FullscreenPass>, RigLayers::max_layers> show_;
    DrawnDepth layer_;
    std::array<DepthPicture, most_shown> shown_;
};

}  // namespace vantage

#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/gl/buffer.h"
#include "common/gl/fullscreen_pass.h"
#include "host_app/synthesis/depth_picture.h"
#include "host_app/synthesis/drawn_texture.h"
#include "host_app/synthesis/mesh_rasteriser.h"
#include "host_app/synthesis/rig_layers.h"

namespace vantage {

/// Learns every rig's background plate along time, and shows it where no rig sees anything now:
/// what a performer uncovers for the virtual camera but hides from every rig.
class BackgroundPlates {
  public:
    explicit BackgroundPlates(const ShaderLibrary& library);

    /// Takes the view's newest depth and colour into its plate. Once an upload.
    void learn(GpuView& view);

    /// `picture` with what the plates of up to two of the layers' rigs remember where its alpha is
    /// below a half; remembered_alpha there. Valid until the next call.
    const DepthPicture& show(const DepthPicture& picture, const RigLayers& layers,
                             const VirtualView& target);

  private:
    static constexpr std::size_t most_shown = 2;

    FullscreenPass& pass(std::size_t layers);

    const ShaderLibrary* library_;
    FullscreenPass learn_;
    MeshRasteriser rasteriser_;
    std::array<std::optional<FullscreenPass>, RigLayers::max_layers> show_;
    DrawnDepth layer_;
    std::array<DepthPicture, most_shown> shown_;
};

}  // namespace vantage

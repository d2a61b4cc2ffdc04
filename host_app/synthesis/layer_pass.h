#pragma once

#include <array>
#include <optional>
#include <string>

#include "common/gl/fullscreen_pass.h"
#include "host_app/synthesis/rig_layers.h"

namespace vantage {

/// Relative depth difference up to which the surfaces of two rigs count as the same surface.
inline constexpr float same_surface_share = 0.005f;

/// A fragment shader that merges layers. It includes rig_layers.glsl and writes the colour and the
/// depth of a DepthPicture. There is one program for every number of layers.
class LayerPass {
  public:
    /// `softness` is the value of the shader's uniform: the relative depth difference up to which
    /// two surfaces are one. Every rig has `layers_per_rig` layers. No programs are made for fewer
    /// than `min_layers` layers.
    LayerPass(const ShaderLibrary& library, std::string fragment, float softness,
              ShaderDefines more = {}, std::size_t layers_per_rig = 1, std::size_t min_layers = 1);

    /// Returns the pass for the number of layers (at least `min_layers`). Its program is in use,
    /// with the layers bound, and ready for more inputs. `notes_origins` also writes the layers'
    /// shares.
    FullscreenPass& use(const RigLayers& layers, bool notes_origins);

  private:
    ShaderDefines defines(std::size_t layers, bool origins) const;

    const ShaderLibrary* library_;
    std::string fragment_;
    float softness_;
    ShaderDefines more_;
    /// By the number of layers minus one. Programs that note origins are made on first use.
    std::array<std::optional<FullscreenPass>, RigLayers::max_layers> plain_, noting_;
};

}  // namespace vantage

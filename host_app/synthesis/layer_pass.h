#pragma once

#include <array>
#include <optional>
#include <string>

#include "common/gl/fullscreen_pass.h"
#include "host_app/synthesis/rig_layers.h"

namespace vantage {

/// Surfaces of two rigs that are nearer to each other than this share of their depth are one.
inline constexpr float same_surface_share = 0.005f;

/// A fragment shader over layers, which includes rig_layers.glsl and writes colour and depth of a
/// DepthPicture; a program for every number of layers.
class LayerPass {
  public:
    /// `softness` is the shader's uniform of that name; every rig has `layers_a_rig` layers; there
    /// are no programs for fewer than `least_layers`.
    LayerPass(const ShaderLibrary& library, std::string fragment, float softness,
              ShaderDefines more = {}, std::size_t layers_a_rig = 1, std::size_t least_layers = 1);

    /// The pass for so many layers as there are (at least `least_layers`), its program in use with
    /// the layers bound, ready for more uniforms; texture units from layers.first_free_unit() on
    /// are free. `notes_origins`: it writes the layers' shares too.
    FullscreenPass& use(const RigLayers& layers, bool notes_origins);

  private:
    ShaderDefines defines(std::size_t layers, bool origins) const;

    const ShaderLibrary* library_;
    std::string fragment_;
    float softness_;
    ShaderDefines more_;
    /// By number of layers less one. Those that note origins are made when they are asked for.
    std::array<std::optional<FullscreenPass>, RigLayers::max_layers> plain_, noting_;
};

}  // namespace vantage

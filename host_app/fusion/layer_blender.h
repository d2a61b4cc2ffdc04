#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/gl/fullscreen_pass.h"
#include "host_app/fusion/depth_picture.h"
#include "host_app/fusion/hole_filler.h"
#include "host_app/fusion/rig_layers.h"

namespace vantage {

/// The end of the road of those synthesisers that differ in how they lay out and weigh the rigs'
/// surfaces: one fragment shader makes the picture from the layers, and what stayed empty is
/// filled.
class LayerBlender {
  public:
    /// `fragment` includes rig_layers.glsl and writes colour and depth of a DepthPicture. Every rig
    /// has `layers_a_rig` layers.
    LayerBlender(const ShaderLibrary& library, std::string fragment, float softness,
                 std::size_t layers_a_rig = 1);

    /// To be drawn before blend().
    RigLayers& layers() { return layers_; }

    /// Sets more uniforms of the shader; texture units from the given one on are free.
    using MoreInputs = std::function<void(Program& program, int first_free_unit)>;
    /// Adds to a picture before its holes are filled.
    using BeforeFilling = std::function<const DepthPicture&(const DepthPicture& blended)>;
    /// The picture of the layers that were drawn last, of the view's size; valid until the next
    /// call.
    const Texture& blend(const VirtualView& view, const MoreInputs& more = {},
                         const BeforeFilling& before_filling = {});

    void note_origins(bool noted) { notes_origins_ = noted; }
    const PixelOrigins* origins() const { return origins_ ? &*origins_ : nullptr; }

  private:
    FullscreenPass& pass(std::size_t layers);

    const ShaderLibrary* library_;
    std::string fragment_;
    float softness_;
    RigLayers layers_;
    /// By number of layers less one. Those that note origins are made when they are asked for.
    std::array<std::optional<FullscreenPass>, RigLayers::max_layers> plain_, noting_;
    DepthPicture blended_;
    HoleFiller filler_;
    bool notes_origins_ = false;
    std::optional<PixelOrigins> origins_;
};

}  // namespace vantage

#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host_app/surfaces/depth_picture.h"
#include "host_app/synthesis/hole_filler.h"
#include "host_app/synthesis/layer_pass.h"
#include "host_app/synthesis/rig_layers.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {

/// The end of the road of those synthesisers that differ in how they lay out and weigh the rigs'
/// surfaces: shaders make the picture from the layers, and what stayed empty is filled.
class LayerBlender {
  public:
    explicit LayerBlender(const ShaderLibrary& library) : layers_(library), filler_(library) {}

    /// To be drawn before blend().
    RigLayers& layers() { return layers_; }

    /// Draws the picture of the layers, of which there is at least one.
    using Drawing = std::function<void(const DepthPicture& into, bool notes_origins)>;
    /// Adds to a picture before its holes are filled.
    using BeforeFilling = std::function<const DepthPicture&(const DepthPicture& blended)>;
    /// The picture of the layers that were drawn last, of the view's size; valid until the next
    /// call. `depth_test`, of the view's size too, is the depth texture that is drawn with.
    const Texture& blend(const VirtualView& view, const Drawing& drawing,
                         const BeforeFilling& before_filling = {},
                         const Texture* depth_test = nullptr);
    /// The same, drawn by one pass.
    const Texture& blend(const VirtualView& view, LayerPass& pass);

    void note_origins(bool noted) { notes_origins_ = noted; }
    const PixelOrigins* origins() const { return origins_ ? &*origins_ : nullptr; }
    /// Of the last picture's layers, as ViewRenderer says. Precondition: blend() was called.
    const Texture& depth_m() const { return blended_.depth_m(); }

  private:
    RigLayers layers_;
    DepthPicture blended_;
    HoleFiller filler_;
    bool notes_origins_ = false;
    std::optional<PixelOrigins> origins_;
};

}  // namespace vantage

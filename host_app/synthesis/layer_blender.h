#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host_app/surfaces/drawn_texture.h"
#include "host_app/surfaces/pull_push.h"
#include "host_app/synthesis/rig_layers.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {

/// Returns the origins of a picture's pixels, whose shares are those of the layers.
PixelOrigins origins_of(const DepthPicture& picture, const RigLayers& layers);

/// The last stage of every synthesiser that draws the rigs' surfaces as layers: a shader merges the
/// layers into an image, and holes are filled. Belongs to one context.
class LayerBlender {
  public:
    explicit LayerBlender(const ShaderLibrary& library) : layers_(library), filler_(library) {}

    /// The layers, which must be drawn before blend().
    RigLayers& layers() { return layers_; }

    /// Merges the layers into an image. Called only if there is at least one layer.
    using Drawing = std::function<void(const DepthPicture& into, bool notes_origins)>;
    /// Adds to the merged image before its holes are filled.
    using BeforeFilling = std::function<const DepthPicture&(const DepthPicture& blended)>;
    /// Returns the image of the layers that were drawn last, in the view's size; valid until the
    /// next call. `depth_test` is a depth texture of the same size for depth-tested drawing.
    const Texture& blend(const VirtualView& view, const Drawing& drawing,
                         const BeforeFilling& before_filling = {},
                         const Texture* depth_test = nullptr);
    /// Merges the layers with a single pass.
    const Texture& blend(const VirtualView& view, LayerPass& pass);

    void note_origins(bool noted) { notes_origins_ = noted; }
    bool notes_origins() const { return notes_origins_; }
    const PixelOrigins* origins() const { return origins_ ? &*origins_ : nullptr; }
    /// The depth of the last image, as ViewRenderer::depth_m(). Precondition: blend() was called.
    const Texture& depth_m() const { return blended_.depth_m(); }

  private:
    RigLayers layers_;
    DepthPicture blended_;
    HoleFiller filler_;
    bool notes_origins_ = false;
    std::optional<PixelOrigins> origins_;
};

}  // namespace vantage

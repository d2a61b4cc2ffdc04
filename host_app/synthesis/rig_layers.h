#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/program.h"
#include "common/gl/objects/vertex_array.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/surfaces/instant.h"
#include "host_app/surfaces/rig_surface.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/views/depth_view.h"
#include "host_app/views/tolerances.h"
#include "host_app/views/view_ranking.h"

namespace vantage {

/// Draws depth maps as regular grids of quads that are displaced by depth, one vertex per pixel.
/// The triangles come from a TriangleBuilder. Belongs to one context.
class MeshRasteriser {
  public:
    /// How depth is written. `plain`: 1 - near / z. `matted`, for surfaces with a matte: half of
    /// that value inside the matte, and half of it plus 0.5 outside, so that depth outside a matte
    /// never hides a surface inside one.
    enum class Depths { plain, matted };
    explicit MeshRasteriser(const ShaderLibrary& library, Depths depths = Depths::plain);

    /// Clears a depth-only framebuffer of the target's size to 1 and draws the view's surface into
    /// it. Surfaces that are seen from behind are left out.
    void draw_depth(const RigSurface& view, const VirtualView& target, double near_m,
                    const Framebuffer& depth_only, QuadGrid grid = QuadGrid::fine);
    void draw_depth(const DepthGrid& grid, const VirtualView& target, double near_m,
                    const Framebuffer& depth_only);

  private:
    Program draw_, draw_rims_;
    VertexArray vertices_;
};

/// One surface of a virtual view, with its weight 0..1 while its rig fades in or out.
struct DrawnLayer {
    const RigSurface* surface = nullptr;
    float presence = 1;
};

/// Returns the distance of the near plane: a hundredth of the scene's typical depth, metres.
double near_plane_m(std::span<const DrawnLayer> layers);

/// The rigs' surfaces in one virtual view. Each is drawn into a depth buffer of its own, in the
/// view's size; a fragment shader that includes rig_layers.glsl merges them. Belongs to one
/// context.
class RigLayers {
  public:
    static constexpr std::size_t max_layers = most_drawn_rigs;

    using Depths = MeshRasteriser::Depths;
    explicit RigLayers(const ShaderLibrary& library, Depths depths = Depths::plain)
        : rasteriser_(library, depths) {}

    /// Draws the surfaces, the first `fine` ones by their fine grids and the others by their coarse
    /// grids. Preconditions: at most max_layers, none null; the grids' triangles have been built.
    void draw(std::span<const DrawnLayer> layers, const VirtualView& target,
              std::size_t fine = max_layers);
    /// Draws one surface into a depth-only framebuffer of the target's size: 1 - near / z, and 1
    /// where there is no surface.
    using Drawing = std::function<void(const RigSurface& surface, double near_m,
                                       const Framebuffer& depth_only)>;
    /// Begins a view of which draw_layer() draws the surfaces one by one. Preconditions as for
    /// draw().
    void begin(std::span<const DrawnLayer> layers, const VirtualView& target);
    void draw_layer(std::size_t layer, QuadGrid grid);
    /// Draws the surfaces with `drawing` instead of their grids.
    void draw(std::span<const DrawnLayer> layers, const VirtualView& target,
              const Drawing& drawing);

    /// Sets the inputs and uniforms of rig_layers.glsl. The program must be in use.
    void bind(Program& program) const;

    std::span<const DrawnLayer> used() const { return used_; }

  private:
    MeshRasteriser rasteriser_;
    std::array<DrawnDepth, max_layers> layers_;
    std::vector<DrawnLayer> used_;
    VirtualView target_;
    double near_m_ = 0;
};

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

/// Returns the `rigs` most useful rigs of an instant for the view, best first.
inline std::vector<const InstantRig*> ranked_rigs(const Instant& instant, const VirtualView& view,
                                                  std::size_t rigs) {
    std::vector<const InstantRig*> all;
    for (const InstantRig& rig : instant.rigs) all.push_back(&rig);
    return most_useful(all, view, rigs);
}

/// Returns one layer of each rig: its background surface, or the foreground in front of it.
inline std::vector<DrawnLayer> layers_of(
    std::span<const InstantRig* const> rigs,
    std::shared_ptr<const RigSurface> InstantRig::*part = &InstantRig::surface) {
    std::vector<DrawnLayer> layers;
    for (const InstantRig* rig : rigs) layers.push_back({(rig->*part).get(), rig->presence});
    return layers;
}

/// Returns the surfaces of the `rigs` most useful rigs as layers, best first.
inline std::vector<DrawnLayer> layers_of(const Instant& instant, const VirtualView& view,
                                         std::size_t rigs) {
    return layers_of(ranked_rigs(instant, view, rigs));
}

/// Returns how many of the layers are drawn with one vertex per pixel.
inline std::size_t finely_drawn(const Instant& instant, const RenderLevel& level) {
    return level.rank == 0 && instant.rigs.size() <= most_drawn_rigs ? most_drawn_rigs
                                                                     : level.finely;
}

}  // namespace vantage

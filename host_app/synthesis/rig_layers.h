#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "common/gl/objects/program.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/surfaces/instant.h"
#include "host_app/synthesis/mesh_rasteriser.h"

namespace vantage {

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

}  // namespace vantage

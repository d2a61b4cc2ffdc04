#pragma once

#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/program.h"
#include "common/gl/objects/vertex_array.h"
#include "host_app/surfaces/rig_surface.h"
#include "host_app/views/virtual_view.h"

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

}  // namespace vantage

#pragma once

#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/program.h"
#include "common/gl/objects/vertex_array.h"
#include "host_app/surfaces/rig_surface.h"
#include "host_app/views/virtual_view.h"

namespace vantage {

/// Draws depth maps as regular grids of quads, a vertex a pixel, displaced by depth; a
/// TriangleBuilder has written their triangles.
class MeshRasteriser {
  public:
    /// How depth is written: 1 - near / z; or, of surfaces with a matte, half of that within it and
    /// half of that and a half beyond, so that nothing beyond a matte hides what is within one.
    enum class Depths { plain, matted };
    explicit MeshRasteriser(const ShaderLibrary& library, Depths depths = Depths::plain);

    /// Draws the view's surface into a depth-only framebuffer of the target's size: 1 - near / z, 1
    /// where there is nothing. Surfaces seen from behind are left out. Clears before.
    void draw_depth(const RigSurface& view, const VirtualView& target, double near_m,
                    const Framebuffer& depth_only, QuadGrid grid = QuadGrid::fine);
    void draw_depth(const DepthGrid& grid, const VirtualView& target, double near_m,
                    const Framebuffer& depth_only);

  private:
    Program draw_, draw_rims_;
    VertexArray vertices_;
};

}  // namespace vantage

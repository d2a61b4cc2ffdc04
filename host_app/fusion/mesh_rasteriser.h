#pragma once

#include "common/gl/framebuffer.h"
#include "common/gl/program.h"
#include "common/gl/vertex_array.h"
#include "host_app/fusion/gpu_view.h"
#include "host_app/fusion/synthesiser.h"

namespace vantage {

/// A depth map as a regular grid of quads, a vertex a pixel, displaced by depth. Where neighbouring
/// pixels lie on different surfaces nothing is spanned between them: the edge filter, a high-pass
/// of the inverse depth, keeps their triangles out.
class MeshRasteriser {
  public:
    explicit MeshRasteriser(const ShaderLibrary& library);

    /// Runs the edge filter over the view's depth and writes its triangles. Once an upload.
    void build_triangles(const GpuView& view, QuadGrid grid = QuadGrid::fine);

    /// Draws the view's surface into a depth-only framebuffer of the target's size: 1 - near / z, 1
    /// where there is nothing. Surfaces seen from behind are left out. Clears before.
    void draw_depth(const GpuView& view, const VirtualView& target, double near_m,
                    const Framebuffer& depth_only, QuadGrid grid = QuadGrid::fine);

  private:
    Program build_, build_coarse_, draw_;
    VertexArray vertices_;
};

}  // namespace vantage

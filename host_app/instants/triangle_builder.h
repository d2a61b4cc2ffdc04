#pragma once

#include "common/gl/program.h"
#include "host_app/instants/rig_surface.h"

namespace vantage {

/// Writes the triangles of a depth map's regular grid of quads, a vertex a pixel. Where
/// neighbouring pixels lie on different surfaces nothing is spanned between them: the edge filter,
/// a high-pass of the inverse depth, keeps their triangles out.
class TriangleBuilder {
  public:
    explicit TriangleBuilder(const ShaderLibrary& library);

    void build(const DepthGrid& grid);

    /// What the fine grid leaves out at the edges of surfaces: half a pixel all round, and all of
    /// what is one pixel wide. Drawn with the fine grid.
    void build_rims(RigSurface& surface);

  private:
    void set_edge_filter(Program& program, const DepthGrid& grid);

    Program build_, build_coarse_, build_rims_;
};

}  // namespace vantage

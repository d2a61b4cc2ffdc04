#pragma once

#include "common/gl/objects/program.h"
#include "host_app/surfaces/rig_surface.h"

namespace vantage {

/// Writes the triangles of a depth map's regular grid of quads, a vertex a pixel. Where
/// neighbouring pixels lie on different surfaces nothing is spanned between them: the edge filter,
/// a high-pass of the inverse depth, keeps their triangles out.
class TriangleBuilder {
  public:
    explicit TriangleBuilder(const ShaderLibrary& library);

    /// The usual bend, see build().
    static constexpr float least_bend = 0.6f;

    /// In the coarse grid, a block of quads that bends by less than `bend`, in units of the
    /// uncertainty of inverse depth, is flat, and becomes two triangles.
    void build(const DepthGrid& grid, float bend = least_bend);
    /// A coarse grid's, only where `tiles` of a picture of this size (TilePass) say so.
    void build_where(const DepthGrid& grid, const Texture& tiles, cv::Size picture,
                     float bend = least_bend);

    /// What the fine grid leaves out at the edges of surfaces: half a pixel all round, and all of
    /// what is one pixel wide. Drawn with the fine grid.
    void build_rims(RigSurface& surface);

  private:
    void build(const DepthGrid& grid, float bend, Program& program);
    void set_edge_filter(Program& program, const DepthGrid& grid);

    Program build_, build_coarse_, build_parts_, build_rims_;
};

}  // namespace vantage

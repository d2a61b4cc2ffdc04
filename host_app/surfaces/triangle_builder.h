#pragma once

#include "common/gl/objects/program.h"
#include "host_app/surfaces/rig_surface.h"

namespace vantage {

/// Builds the triangles of a depth map's regular grid of quads, with a vertex for each pixel. No
/// triangle connects neighbouring pixels of different surfaces: an edge filter, a high-pass of the
/// inverse depth, removes them.
class TriangleBuilder {
  public:
    explicit TriangleBuilder(const ShaderLibrary& library);

    /// The default bend of build(): below the noise of the depth.
    static constexpr float default_bend = 0.6f;

    /// Builds the triangles of the grid. In the coarse grid, a block of quads that bends by less
    /// than `bend` standard deviations of the inverse depth becomes two triangles.
    void build(const DepthGrid& grid, float bend = default_bend);
    /// Builds only the blocks of a coarse grid in the selected tiles of a picture of this size (see
    /// TilePass).
    void build_where(const DepthGrid& grid, const Texture& tiles, cv::Size picture,
                     float bend = default_bend);

    /// Builds the rims, which the fine grid lacks at the edges of surfaces: half a pixel all round,
    /// and all objects that are one pixel wide. They are drawn with the fine grid.
    void build_rims(RigSurface& surface);

  private:
    void build(const DepthGrid& grid, float bend, Program& program);
    void set_edge_filter(Program& program, const DepthGrid& grid);

    Program build_, build_coarse_, build_parts_, build_rims_;
};

}  // namespace vantage

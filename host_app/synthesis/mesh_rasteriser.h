#pragma once

#include "common/gl/framebuffer.h"
#include "common/gl/program.h"
#include "common/gl/vertex_array.h"
#include "host_app/synthesis/gpu_view.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {

/// A depth map of a camera, as a grid of quads.
struct DepthGrid {
    const Texture& depth_m;   ///< r32f, 0 = unknown, negative = guessed
    const Buffer& triangles;  ///< of triangle_indices() of the depth map's size and the grid
    Eigen::Matrix3d K;        ///< of the depth map
    Pose world_from_camera;
    QuadGrid grid = QuadGrid::fine;
    const SurfaceRims* rims = nullptr;  ///< drawn too where there are any
    double rim_px = 0;                  ///< how far they reach from the middles of their pixels
};

/// A depth map as a regular grid of quads, a vertex a pixel, displaced by depth. Where neighbouring
/// pixels lie on different surfaces nothing is spanned between them: the edge filter, a high-pass
/// of the inverse depth, keeps their triangles out.
class MeshRasteriser {
  public:
    explicit MeshRasteriser(const ShaderLibrary& library);

    /// Runs the edge filter over the view's depth and writes its triangles. Once an upload.
    void build_triangles(const GpuView& view, QuadGrid grid = QuadGrid::fine);
    void build_triangles(const DepthGrid& grid);

    /// What the fine grid leaves out at the edges of surfaces: half a pixel all round, and all of
    /// what is one pixel wide. Drawn with the fine grid from then on. Once an upload.
    void build_rims(GpuView& view);

    /// Draws the view's surface into a depth-only framebuffer of the target's size: 1 - near / z, 1
    /// where there is nothing. Surfaces seen from behind are left out. Clears before.
    void draw_depth(const GpuView& view, const VirtualView& target, double near_m,
                    const Framebuffer& depth_only, QuadGrid grid = QuadGrid::fine);
    void draw_depth(const DepthGrid& grid, const VirtualView& target, double near_m,
                    const Framebuffer& depth_only);

  private:
    void set_edge_filter(Program& program, const DepthGrid& grid);

    Program build_, build_coarse_, build_rims_, draw_, draw_rims_;
    VertexArray vertices_;
};

}  // namespace vantage

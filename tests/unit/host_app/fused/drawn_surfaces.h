#pragma once

#include <memory>
#include <vector>

#include "host_app/surfaces/rig_surface.h"
#include "host_app/synthesis/rig_layers.h"

namespace vantage {

/// Surfaces of views as they are, ready to be drawn. A context must be current.
class DrawnSurfaces {
  public:
    explicit DrawnSurfaces(const ShaderLibrary& library) : triangles_(library) {}

    const RigSurface& add(const DepthView& view, bool has_rims = false) {
        RigSurface& surface = *surfaces_.emplace_back(std::make_unique<RigSurface>());
        surface.upload(view, corrector_, uploader_);
        for (const QuadGrid grid : {QuadGrid::fine, QuadGrid::coarse})
            triangles_.build(surface.grid(grid));
        if (has_rims) triangles_.build_rims(surface);
        return surface;
    }
    /// All that were added, in their order.
    std::vector<DrawnLayer> layers() const {
        std::vector<DrawnLayer> layers;
        for (const auto& surface : surfaces_) layers.push_back({surface.get(), 1.0f});
        return layers;
    }

  private:
    TriangleBuilder triangles_;
    std::unique_ptr<ColourCorrector> corrector_;
    std::unique_ptr<DepthUploader> uploader_;
    std::vector<std::unique_ptr<RigSurface>> surfaces_;
};

/// A wall of one colour at z = `depth_m`, from (x, 0, 0) along z.
inline DepthView plain_wall(double x_m, cv::Size size, float depth_m, const cv::Vec4b& colour) {
    DepthView view;
    view.name = "at " + std::to_string(x_m);
    view.K << size.width, 0, 0.5 * (size.width - 1), 0, size.width, 0.5 * (size.height - 1), 0, 0,
        1;
    view.world_from_camera.translation().x() = x_m;
    view.colour = ColourImage(size, colour);
    view.depth_m = DepthImage(size, depth_m);
    return view;
}

inline VirtualView camera_of(const DepthView& view) {
    return {view.colour.cols, view.colour.rows, view.K, view.world_from_camera};
}

}  // namespace vantage

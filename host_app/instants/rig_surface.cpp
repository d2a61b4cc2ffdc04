#include "host_app/instants/rig_surface.h"

#include <algorithm>

#include "host_app/instants/projection.h"

namespace vantage {

int triangle_indices(cv::Size depth_size, QuadGrid grid) {
    const int step = static_cast<int>(grid);
    return 6 * ((depth_size.width - 1) / step) * ((depth_size.height - 1) / step);
}

SurfaceRims::SurfaceRims(int most_indices)
    : indices(static_cast<std::size_t>(most_indices) * sizeof(std::uint32_t), GL_DYNAMIC_DRAW),
      command(5 * sizeof(std::uint32_t), GL_DYNAMIC_DRAW),
      capacity(most_indices) {}

void upload_colour(const DepthView& view, std::unique_ptr<ColourCorrector>& corrector,
                   Texture& into) {
    if (view.colour_correction.is_identity()) {
        into.upload(view.colour);
    } else {
        if (!corrector) corrector = std::make_unique<ColourCorrector>();
        corrector->upload(view.colour, view.colour_correction, into);
    }
}

void RigSurface::begin(const DepthView& camera, cv::Size colour_size, cv::Size depth_size,
                       const SurfaceSamples& samples) {
    camera_ = camera;
    camera_.release_pictures();
    samples_ = samples;
    has_rims_ = false;
    has_fine_grid_ = true;
    plate_.reset();
    colour_.resize(colour_size);
    drawn_.resize(depth_size);
    if (grid_size_ == depth_size) return;
    const auto make = [&](QuadGrid grid, std::optional<Buffer>& triangles) {
        const auto indices =
            static_cast<std::size_t>(std::max(vantage::triangle_indices(depth_size, grid), 1));
        triangles.emplace(indices * sizeof(std::uint32_t), GL_DYNAMIC_DRAW);
    };
    make(QuadGrid::fine, triangles_);
    make(QuadGrid::coarse, coarse_triangles_);
    rims_.reset();
    grid_size_ = depth_size;
}

void RigSurface::upload(const DepthView& view, std::unique_ptr<ColourCorrector>& corrector,
                        std::unique_ptr<DepthUploader>& uploader) {
    begin(view, view.colour.size(), view.depth_size(), surface_samples(view));
    upload_depth(view, uploader, drawn_);
    upload_colour(view, corrector, colour_.texture());
    colour_.generate_mipmaps();
}

const SurfaceRims& RigSurface::rims_to_build() {
    // A quarter of a quad takes as many indices as a quad of the grid: enough for a picture a
    // quarter of whose pixels lie at edges.
    if (!rims_) rims_.emplace(std::max(triangle_indices(), 24));
    has_rims_ = true;
    return *rims_;
}

Eigen::Matrix3d RigSurface::K_depth() const {
    return scaled_intrinsics(camera_.K,
                             static_cast<double>(depth().width_px()) / colour().width_px(),
                             static_cast<double>(depth().height_px()) / colour().height_px());
}

DepthGrid RigSurface::grid(QuadGrid grid) const {
    return {depth(), triangles(grid), K_depth(), camera_.world_from_camera, grid};
}

}  // namespace vantage

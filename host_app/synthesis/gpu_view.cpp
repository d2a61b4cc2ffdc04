#include "host_app/synthesis/gpu_view.h"

#include <algorithm>

#include "host_app/synthesis/projection.h"

namespace vantage {

int triangle_indices(cv::Size depth_size, QuadGrid grid) {
    const int step = static_cast<int>(grid);
    return 6 * ((depth_size.width - 1) / step) * ((depth_size.height - 1) / step);
}

SurfaceRims::SurfaceRims(int most_indices)
    : indices(static_cast<std::size_t>(most_indices) * sizeof(std::uint32_t), GL_DYNAMIC_DRAW),
      command(5 * sizeof(std::uint32_t), GL_DYNAMIC_DRAW),
      capacity(most_indices) {}

const SurfaceRims& GpuView::rims_to_build() {
    // A quarter of a quad takes as many indices as a quad of the grid: enough for a picture a
    // quarter of whose pixels lie at edges.
    if (!rims_) rims_.emplace(std::max(triangle_indices(), 24));
    return *rims_;
}

void GpuView::upload(const DepthView& view) {
    const bool is_same_camera =
        colour_ && depth_ && colour_->size() == view.colour.size() &&
        depth_->size() == view.depth_m.size() && camera_.K == view.K &&
        camera_.world_from_camera.matrix() == view.world_from_camera.matrix();
    if (!is_same_camera || !is_prepared_) {
        steady_colour_.forget();
        steady_.forget();
        settled_.forget();
    }
    if (!is_same_camera) plate_->forget();
    is_prepared_ = false;
    is_colour_steady_ = false;
    camera_ = view;
    camera_.colour.release();
    camera_.depth_m.release();
    if (!colour_ || colour_->size() != view.colour.size())
        colour_.emplace(TextureFormat::rgba8, view.colour.cols, view.colour.rows, Filter::linear,
                        true);
    if (!depth_ || depth_->size() != view.depth_m.size()) {
        depth_.emplace(TextureFormat::r32f, view.depth_m.cols, view.depth_m.rows);
        const auto make = [&](QuadGrid grid, std::optional<Buffer>& triangles) {
            const auto indices = static_cast<std::size_t>(std::max(triangle_indices(grid), 1));
            triangles.emplace(indices * sizeof(std::uint32_t), GL_DYNAMIC_DRAW);
        };
        make(QuadGrid::fine, triangles_);
        make(QuadGrid::coarse, coarse_triangles_);
        rims_.reset();
    }
    if (view.colour_correction.is_identity()) {
        colour_->upload(view.colour);
    } else {
        if (!corrector_) corrector_ = std::make_unique<ColourCorrector>();
        corrector_->upload(view.colour, view.colour_correction, *colour_);
    }
    colour_->generate_mipmaps();
    depth_->upload(view.depth_m);
    samples_ = surface_samples(view);
}

const Framebuffer& GpuView::surface_target() {
    surface_.resize(depth_->size());
    return surface_.target();
}

const Framebuffer& GpuView::trusted_colour_target() {
    trusted_.resize(colour_->size());
    return trusted_.target();
}

Eigen::Matrix3d GpuView::K_depth() const {
    return scaled_intrinsics(camera_.K,
                             static_cast<double>(depth_->width_px()) / colour_->width_px(),
                             static_cast<double>(depth_->height_px()) / colour_->height_px());
}

int GpuView::triangle_indices(QuadGrid grid) const {
    return vantage::triangle_indices(depth_->size(), grid);
}

void upload_views(std::span<const DepthView> views, std::vector<std::unique_ptr<GpuView>>& on_gpu) {
    std::size_t used = 0;
    for (const DepthView& view : views) {
        if (view.depth_m.empty() || view.colour.empty()) continue;
        if (used == on_gpu.size()) on_gpu.push_back(std::make_unique<GpuView>());
        on_gpu[used++]->upload(view);
    }
    on_gpu.resize(used);
}

}  // namespace vantage

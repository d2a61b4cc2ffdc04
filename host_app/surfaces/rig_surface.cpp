#include "host_app/surfaces/rig_surface.h"

#include <algorithm>

#include "host_app/views/projection.h"

namespace vantage {

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
    colour_.resize(colour_size);
    if (shape_.use_count() > 1) shape_ = shapes_->take();
    shape_->has_rims = false;
    shape_->has_fine_grid = true;
    shape_->depth.resize(depth_size);
    if (shape_->grid_size == depth_size) return;
    shape_->triangles.emplace(triangle_indices(depth_size));
    shape_->coarse_triangles.emplace(triangle_indices(depth_size));
    shape_->rims.reset();
    shape_->grid_size = depth_size;
}

void RigSurface::begin_like(const RigSurface& other, const SurfaceSamples& samples) {
    camera_ = other.camera_;
    samples_ = samples;
    colour_.resize(other.colour().size());
    shape_ = other.shape_;
}

void RigSurface::upload(const DepthView& view, std::unique_ptr<ColourCorrector>& corrector,
                        std::unique_ptr<DepthUploader>& uploader) {
    begin(view, view.colour.size(), view.has_depth() ? view.depth_size() : cv::Size(1, 1),
          surface_samples(view));
    if (view.has_depth())
        upload_depth(view, uploader, shape_->depth);
    else
        shape_->depth.texture().upload(DepthImage(1, 1, 0.0f));
    upload_colour(view, corrector, colour_.texture());
    colour_.generate_mipmaps();
}

const IndirectTriangles& RigSurface::rims_to_build() {
    // A quarter of a quad needs as many indices as a whole quad, so this suffices for a picture
    // with a quarter of its pixels at edges.
    if (!shape_->rims) shape_->rims.emplace(std::max(triangle_indices(depth().size()), 24));
    shape_->has_rims = true;
    return *shape_->rims;
}

Eigen::Matrix3d RigSurface::K_depth() const {
    return scaled_intrinsics(camera_.K,
                             static_cast<double>(depth().width_px()) / colour().width_px(),
                             static_cast<double>(depth().height_px()) / colour().height_px());
}

DepthGrid RigSurface::grid(QuadGrid grid) const {
    return {depth(), triangles(grid),      K_depth(), camera_.world_from_camera,
            grid,    depth_spread(camera_)};
}

}  // namespace vantage

#pragma once

#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "common/colour/colour_pass.h"
#include "host_app/surfaces/depth_grid.h"
#include "host_app/surfaces/depth_uploader.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/surfaces/recycle_pool.h"
#include "host_app/views/depth_view.h"
#include "host_app/views/surface_samples.h"

namespace vantage {

/// What is drawn of one rig at one instant. Made on the context that prepares instants; once its
/// instant is published nothing of it changes, and any context that shares objects may read it.
class RigSurface {
  public:
    /// What does not change with the colours.
    struct Shape {
        DrawnTexture depth{TextureFormat::r32f};
        DrawnTexture confidence{TextureFormat::r8};
        bool has_rims = false, has_fine_grid = true;
        std::optional<IndirectTriangles> triangles, coarse_triangles, rims;
        cv::Size grid_size;
    };

    using Shapes = RecyclePool<Shape>;

    /// Surfaces that share shapes share where those come from.
    explicit RigSurface(std::shared_ptr<Shapes> shapes = std::make_shared<Shapes>())
        : shapes_(std::move(shapes)) {}

    /// Trust in a colour that is not seen now but was before: less than in any that is.
    static constexpr float remembered_confidence = 4.0f / 255;

    /// Camera, name and sizes; its pictures are empty.
    const DepthView& camera() const { return camera_; }
    /// Metres in the first channel, 0 = unknown, negative = guessed.
    const Texture& depth() const { return shape_->depth.texture(); }
    /// rgba8, trilinear; alpha says how far the colour can be trusted.
    const Texture& colour() const { return colour_.texture(); }

    /// Of the depth map.
    const IndirectTriangles& triangles(QuadGrid grid = QuadGrid::fine) const {
        return grid == QuadGrid::fine ? *shape_->triangles : *shape_->coarse_triangles;
    }
    /// Whether triangles of the fine grid were built.
    bool has_fine_grid() const { return shape_->has_fine_grid; }
    /// Null where none were built.
    const IndirectTriangles* rims() const { return shape_->has_rims ? &*shape_->rims : nullptr; }
    Eigen::Matrix3d K_depth() const;
    DepthGrid grid(QuadGrid grid) const;

    /// A few known surface points in world coordinates, evenly over the picture.
    std::span<const Eigen::Vector3d> sample_points_m() const { return samples_.points_m; }
    double median_depth_m() const { return samples_.median_depth_m; }
    const SurfaceSamples& samples() const { return samples_; }

    // For those that make it.

    /// Begins anew for an instant of this camera, whose picture and depth map have these sizes.
    void begin(const DepthView& camera, cv::Size colour_size, cv::Size depth_size,
               const SurfaceSamples& samples);
    /// Likewise, with the depth, the triangles and the trust of another one of this camera, of
    /// which nothing may change from then on.
    void begin_like(const RigSurface& other, const SurfaceSamples& samples);
    /// The view as it came; without depth, its map is one unknown pixel.
    void upload(const DepthView& view, std::unique_ptr<ColourCorrector>& corrector,
                std::unique_ptr<DepthUploader>& uploader);
    const Framebuffer& depth_target() const { return shape_->depth.target(); }
    /// r8, of the picture's size: how far the depth lets its colours be trusted (see EdgeTrust).
    DrawnTexture& confidence() { return shape_->confidence; }
    const Framebuffer& colour_target() const { return colour_.target(); }
    void finish_colour() { colour_.generate_mipmaps(); }
    const IndirectTriangles& rims_to_build();
    void set_has_fine_grid(bool has) { shape_->has_fine_grid = has; }

  private:
    DepthView camera_;
    SurfaceSamples samples_;
    std::shared_ptr<Shapes> shapes_;
    std::shared_ptr<Shape> shape_ = shapes_->take();
    DrawnTexture colour_{TextureFormat::rgba8, Filter::linear, true};
};

/// A view's picture, with its colour correction, into a texture of its size.
/// `corrector` is made when a view first needs one.
void upload_colour(const DepthView& view, std::unique_ptr<ColourCorrector>& corrector,
                   Texture& into);

}  // namespace vantage

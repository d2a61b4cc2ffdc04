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

/// The surface of one rig at one instant: depth, triangles and colour on the GPU. Made on the GL
/// context that prepares instants. It does not change after its instant is published, and any
/// context that shares objects may read it.
class RigSurface {
  public:
    /// The part that does not depend on the colours; surfaces may share it.
    struct Shape {
        DrawnTexture depth{TextureFormat::r32f};
        DrawnTexture confidence{TextureFormat::r8};
        bool has_rims = false, has_fine_grid = true;
        std::optional<IndirectTriangles> triangles, coarse_triangles, rims;
        cv::Size grid_size;
    };

    using Shapes = RecyclePool<Shape>;

    /// `shapes` is the pool that shapes come from and return to.
    explicit RigSurface(std::shared_ptr<Shapes> shapes = std::make_shared<Shapes>())
        : shapes_(std::move(shapes)) {}

    /// Confidence of a colour that is hidden now and was seen before: lower than of any visible
    /// one.
    static constexpr float remembered_confidence = 4.0f / 255;

    /// Camera and name, without pictures.
    const DepthView& camera() const { return camera_; }
    /// Metres in the first channel, 0 = unknown, negative = inpainted.
    const Texture& depth() const { return shape_->depth.texture(); }
    /// rgba8, trilinear; alpha is the confidence of the colour.
    const Texture& colour() const { return colour_.texture(); }

    /// The triangles of the depth map.
    const IndirectTriangles& triangles(QuadGrid grid = QuadGrid::fine) const {
        return grid == QuadGrid::fine ? *shape_->triangles : *shape_->coarse_triangles;
    }
    /// Whether triangles of the fine grid were built.
    bool has_fine_grid() const { return shape_->has_fine_grid; }
    /// Null if none were built.
    const IndirectTriangles* rims() const { return shape_->has_rims ? &*shape_->rims : nullptr; }
    Eigen::Matrix3d K_depth() const;
    DepthGrid grid(QuadGrid grid) const;

    /// A few surface points in world coordinates, evenly over the picture.
    std::span<const Eigen::Vector3d> sample_points_m() const { return samples_.points_m; }
    double median_depth_m() const { return samples_.median_depth_m; }
    const SurfaceSamples& samples() const { return samples_; }

    // For the preparer.

    /// Starts a surface of this camera with a picture and a depth map of these sizes.
    void begin(const DepthView& camera, cv::Size colour_size, cv::Size depth_size,
               const SurfaceSamples& samples);
    /// Starts a surface that shares the shape of another one of this camera; the shape must not
    /// change from then on.
    void begin_like(const RigSurface& other, const SurfaceSamples& samples);
    /// Uploads a view without processing; without depth, the depth map is one unknown pixel.
    void upload(const DepthView& view, std::unique_ptr<ColourCorrector>& corrector,
                std::unique_ptr<DepthUploader>& uploader);
    const Framebuffer& depth_target() const { return shape_->depth.target(); }
    /// r8, of the picture's size: the edge confidence (see EdgeConfidence).
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

/// Uploads a view's picture, with its colour correction, to a texture of its size. Creates
/// `corrector` when a view first needs it.
void upload_colour(const DepthView& view, std::unique_ptr<ColourCorrector>& corrector,
                   Texture& into);

}  // namespace vantage

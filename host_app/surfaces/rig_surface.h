#pragma once

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/colour/colour_pass.h"
#include "common/geometry/pose.h"
#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "common/gl/objects/texture.h"
#include "common/gl/shader_library.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/surfaces/recycle_pool.h"
#include "host_app/views/depth_view.h"

namespace vantage {

/// Uploads a view's depth. Disparities are uploaded as 16 bits for each pixel and converted to
/// metres by a table of all 65536 values, so that every GPU gives the same bits as the CPU. The
/// context that was current at construction must be current at every call.
class DepthUploader {
  public:
    /// Uploads to `into` (r32f, metres, 0 = unknown), which gets the size of the view's depth.
    /// Precondition: the view has disparities.
    void upload(const DepthView& view, DrawnTexture& into);

  private:
    const Texture& table_of(const DisparityScale& scale);

    ShaderLibrary library_;
    FullscreenPass pass_{library_, "disparity_depth.frag"};
    std::optional<Texture> steps_;
    std::vector<std::pair<DisparityScale, Texture>> tables_;  ///< one for each geometry
};

/// Uploads a view's depth map or disparities to `into`, as DepthUploader does. Creates `uploader`
/// when a view first has disparities. Precondition: the view has depth.
void upload_depth(const DepthView& view, std::unique_ptr<DepthUploader>& uploader,
                  DrawnTexture& into);

/// Pixels of a depth map that a quad of its grid spans; a coarse quad that is cut becomes quads of
/// one pixel.
enum class QuadGrid { fine = 1, coarse = 2 };

/// The number of indices of a depth map's triangles, two for each pixel.
int triangle_indices(cv::Size depth_size);

/// Triangles of a depth map as an indirect draw: only the GPU knows their number.
struct IndirectTriangles {
    Buffer indices, command;
    int capacity;  ///< indices

    explicit IndirectTriangles(int max_indices);
    /// Removes all triangles and prepares for a shader that writes new ones: binds the indices to
    /// storage 0 and the command to storage 1.
    void begin() const;
    /// Draws with the program and the vertex array in use.
    void draw() const;
};

/// A camera's depth map as a grid of quads. Refers to textures and buffers that must outlive it.
struct DepthGrid {
    const Texture& depth_m;  ///< metres in its first channel, 0 = unknown, negative = inpainted
    const IndirectTriangles& triangles;
    Eigen::Matrix3d K;  ///< of the depth map
    Pose world_from_camera;
    QuadGrid grid = QuadGrid::fine;
    float spread = 0;                         ///< depth_spread() of the camera
    const IndirectTriangles* rims = nullptr;  ///< drawn with the triangles if not null
    double rim_px = 0;  ///< reach of the rims from the middles of their pixels
};

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

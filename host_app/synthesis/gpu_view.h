#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/colour/colour_corrector.h"
#include "common/gl/buffer.h"
#include "common/gl/texture.h"
#include "host_app/synthesis/depth_view.h"
#include "host_app/synthesis/drawn_texture.h"
#include "host_app/synthesis/learnt_plate.h"
#include "host_app/synthesis/steady_colour.h"
#include "host_app/synthesis/surface_samples.h"

namespace vantage {

/// How many pixels of a depth map a quad of its grid spans.
enum class QuadGrid { fine = 1, coarse = 2 };

/// Two triangles a quad of the grid over a depth map of this size.
int triangle_indices(cv::Size depth_size, QuadGrid grid);

/// Triangles at the edges of a depth map's surfaces, as an indirect draw: how many they are is
/// known to the GPU alone.
struct SurfaceRims {
    Buffer indices, command;
    int capacity;  ///< indices

    explicit SurfaceRims(int most_indices);
};

/// One depth view on the GPU. Textures stay while the sizes stay.
class GpuView {
  public:
    /// Precondition: the view has depth.
    void upload(const DepthView& view);

    /// Camera, name and sizes as in the last upload; its pictures are empty.
    const DepthView& camera() const { return camera_; }
    const Texture& depth() const { return *depth_; }  ///< r32f, metres, 0 = unknown
    /// rgba8, trilinear: fresh_colour(), or what finish_colour() saw drawn of it since.
    const Texture& colour() const {
        return is_colour_steady_ ? steady_colour_.picture() : fresh_colour();
    }
    const Texture& fresh_colour() const { return *colour_; }
    bool has_colour_before() const { return steady_colour_.is_drawn(); }
    /// Precondition: has_colour_before(). After finish_colour() that of this upload.
    const Texture& colour_mean() const { return steady_colour_.mean(); }
    const Framebuffer& next_colour_target() { return steady_colour_.next_target(colour_->size()); }
    void finish_colour() {
        steady_colour_.finish();
        is_colour_steady_ = true;
    }
    /// The depth that is drawn: depth(), or what was drawn into surface_target() since, or of that
    /// what finish_settled_surface() saw drawn last into next_settled_target().
    const Texture& surface() const {
        return settled_.is_drawn() ? settled_.texture() : fresh_surface();
    }
    const Texture& fresh_surface() const { return surface_.empty() ? *depth_ : surface_.texture(); }
    bool has_settled_surface() const { return settled_.is_drawn(); }
    const Framebuffer& next_settled_target() { return settled_.next_target(depth_->size()); }
    void finish_settled_surface() { settled_.finish(); }
    /// To draw mended depth into: r32f, of depth()'s size, negative = guessed.
    const Framebuffer& surface_target();
    /// colour() with what finish_trusted_colour() saw drawn into its target since: alpha is how far
    /// the colour can be trusted. colour() itself where nothing was drawn.
    const Texture& trusted_colour() const {
        return trusted_.empty() ? colour() : trusted_.texture();
    }
    const Framebuffer& trusted_colour_target();
    void finish_trusted_colour() { trusted_.generate_mipmaps(); }
    /// depth() filtered along time, with a second channel of the filter's own: what
    /// finish_steady_depth() saw drawn last into next_steady_target(). depth() itself where nothing
    /// was.
    const Texture& steady_depth() const { return steady_.is_drawn() ? steady_.texture() : *depth_; }
    bool has_steady_depth() const { return steady_.is_drawn(); }
    const Framebuffer& next_steady_target() { return steady_.next_target(depth_->size()); }
    void finish_steady_depth() { steady_.finish(); }

    /// Whether what is drawn of this rig was made of the last upload. A rig that was not drawn has
    /// no past to steady its colour and depth with.
    bool is_prepared() const { return is_prepared_; }
    void set_prepared() { is_prepared_ = true; }

    /// What this rig has learnt of its background; another camera or size begins anew.
    LearntPlate& plate() const { return *plate_; }

    /// How far this rig takes part, 0..1: it fades in when it comes and out when it is gone.
    float presence() const { return presence_; }
    void set_presence(float presence) { presence_ = presence; }

    /// Index buffer of the depth map's triangles: two a quad of the grid.
    const Buffer& triangles(QuadGrid grid = QuadGrid::fine) const {
        return grid == QuadGrid::fine ? *triangles_ : *coarse_triangles_;
    }
    /// Null until they are asked for.
    const SurfaceRims* rims() const { return rims_ ? &*rims_ : nullptr; }
    const SurfaceRims& rims_to_build();
    Eigen::Matrix3d K_depth() const;
    int triangle_indices(QuadGrid grid = QuadGrid::fine) const;

    /// A few known surface points in world coordinates, evenly over the picture.
    std::span<const Eigen::Vector3d> sample_points_m() const { return samples_.points_m; }
    double median_depth_m() const { return samples_.median_depth_m; }

  private:
    DepthView camera_;
    std::optional<Texture> colour_, depth_;
    std::unique_ptr<ColourCorrector> corrector_;  ///< null until a view needs one
    DrawnTexture surface_{TextureFormat::r32f};
    DrawnTexture trusted_{TextureFormat::rgba8, Filter::linear, true};
    DrawnInTurn steady_{TextureFormat::rg32f}, settled_{TextureFormat::rg32f};
    SteadyColour steady_colour_;
    bool is_colour_steady_ = false, is_prepared_ = false;
    float presence_ = 1;
    std::unique_ptr<LearntPlate> plate_ = std::make_unique<LearntPlate>();
    std::optional<Buffer> triangles_, coarse_triangles_;
    std::optional<SurfaceRims> rims_;
    SurfaceSamples samples_;
};

/// Uploads those views that have depth, in order, reusing what is there.
void upload_views(std::span<const DepthView> views, std::vector<std::unique_ptr<GpuView>>& on_gpu);

}  // namespace vantage

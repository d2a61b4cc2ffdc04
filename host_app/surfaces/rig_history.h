#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "host_app/surfaces/background_state.h"
#include "host_app/surfaces/denoised_colour.h"
#include "host_app/surfaces/depth_uploader.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/surfaces/rig_surface.h"

namespace vantage {

/// Between two instants, where nobody says.
inline constexpr double nominal_dt_s = 1.0 / 30;

/// What the preparing of instants keeps of one rig: its newest picture and depth on the GPU, and
/// what was learnt of it along time. Textures stay while the sizes stay.
class RigHistory {
  public:
    /// Takes a view that was filmed `dt_s` after the one before; another camera or size begins
    /// anew. Precondition: the view has depth.
    void upload(const DepthView& view, double dt_s = nominal_dt_s);
    /// What was learnt along time is of no use any more.
    void forget();
    /// What was published is not shown any more.
    void hide();

    /// Camera, name and sizes as in the last upload; its pictures are empty.
    const DepthView& camera() const { return camera_; }
    const Texture& depth() const { return depth_.texture(); }  ///< r32f, metres, 0 = unknown
    /// rgba8: fresh_colour(), without mip levels, or, trilinear, what finish_colour() saw drawn of
    /// it since.
    const Texture& colour() const {
        return is_colour_denoised_ ? denoised_colour_.picture() : fresh_colour();
    }
    const Texture& fresh_colour() const { return *colour_; }
    bool has_colour_before() const { return denoised_colour_.is_drawn(); }
    /// Precondition: has_colour_before(). After finish_colour() that of this upload.
    const Texture& colour_mean() const { return denoised_colour_.mean(); }
    const Framebuffer& next_colour_target() { return denoised_colour_.next_target(colour_->size()); }
    void finish_colour() {
        denoised_colour_.finish();
        is_colour_denoised_ = true;
    }
    /// Before finish_colour()'s picture is read at coarser levels.
    void generate_mipmaps() { denoised_colour_.generate_mipmaps(); }
    /// The set's depth in the first channel; depth() itself where none was learnt of this upload.
    const Texture& steady_depth() const { return is_background_learnt_ ? set_.state() : depth(); }
    const BackgroundState& background_state() const { return set_; }
    BackgroundState& set_to_learn() {
        set_.resize(depth().size());
        return set_;
    }
    void finish_set() {
        set_.finish();
        is_background_learnt_ = true;
        ++learnt_instants_;
    }
    /// Begins with what was learnt before: the states of both, as they are read back.
    void restore(const cv::Mat4f& background_state, const cv::Mat& colour_mean, int instants) {
        set_.resize(depth().size());
        set_.restore(background_state);
        denoised_colour_.resize(colour_->size());
        denoised_colour_.restore(colour_mean);
        learnt_instants_ = instants;
    }
    /// Instants that the set was learnt of.
    int learnt_instants() const { return learnt_instants_; }
    /// The set as it was bettered last, and how well (see PrepareLevel::rank); null before the
    /// first.
    struct Model {
        std::shared_ptr<const RigSurface> surface;
        int rank = 0;
        double rest_s = 0;  ///< before there is a use in making it anew
        double made_s = 0;  ///< on the preparer's clock
        int made = 0;       ///< learnt_instants() by then
    };
    const std::optional<Model>& model() const { return model_; }
    void set_background_model(const Model& model) {
        model_ = model;
        shape_made_s_.reset();
    }

    /// When the depth and the triangles of the published surface() were made of this model, on the
    /// preparer's clock; empty where they are made anew for every instant.
    std::optional<double> shape_made_s() const { return shape_made_s_; }
    void set_shape_made_s(std::optional<double> made_s) { shape_made_s_ = made_s; }

    /// The right pictures that came last, the oldest first.
    const std::deque<SharedBytes>& right_jpegs() const { return right_jpegs_; }

    /// The set's depth as it was matched against other rigs' sets (see match_sets()).
    struct Match {
        Texture depth_m;           ///< r32f, metres, 0 = unknown
        Texture learnt_m, colour;  ///< r32f and rgba8: what had been learnt then
    };
    const std::optional<Match>& match() const { return match_; }
    /// All of one size: the depth's, or a part of it.
    void set_background_match(const DepthImage& depth_m, const DepthImage& learnt_m,
                   const ColourImage& colour);
    /// The set's depth with what of the match still holds, to be drawn and read.
    DrawnTexture& matched_depth() { return matched_depth_; }

    /// The performers' share of each pixel of the picture, r8, and the tiles of it in which there
    /// are any (see TilePass).
    DrawnTexture& matte() { return matte_; }
    const Texture& matte() const { return matte_.texture(); }
    DrawnTexture& matte_tiles() { return matte_tiles_; }
    const Texture& matte_tiles() const { return matte_tiles_.texture(); }
    /// Their depth, r32f, metres, 0 = none, negative beyond the matte.
    DrawnTexture& foreground_depth() { return foreground_depth_; }
    const Texture& foreground_depth() const { return foreground_depth_.texture(); }

    /// Since the upload before, or the last one that was learnt of.
    double dt_s() const { return dt_s_; }

    /// What was published of this rig last, and whether it was made of the last upload and how well
    /// (see PrepareLevel::rank; lower is better).
    const std::shared_ptr<const RigSurface>& surface() const { return surface_; }
    const std::shared_ptr<const RigSurface>& performers() const { return performers_; }
    std::optional<int> prepared_rank() const { return prepared_rank_; }
    void publish(std::shared_ptr<const RigSurface> surface,
                 std::shared_ptr<const RigSurface> performers, int rank) {
        surface_ = std::move(surface);
        performers_ = std::move(performers);
        prepared_rank_ = rank;
    }
    /// How far this rig takes part, 0..1.
    float presence() const { return presence_; }
    void set_presence(float presence) { presence_ = presence; }

    Eigen::Matrix3d K_depth() const;

    const SurfaceSamples& samples() const { return samples_; }
    std::span<const Eigen::Vector3d> sample_points_m() const { return samples_.points_m; }
    double median_depth_m() const { return samples_.median_depth_m; }

  private:
    DepthView camera_;
    double dt_s_ = nominal_dt_s;
    std::optional<Texture> colour_;
    DrawnTexture depth_{TextureFormat::r32f};
    std::unique_ptr<ColourCorrector> corrector_;  ///< null until a view needs one
    std::unique_ptr<DepthUploader> uploader_;     ///< likewise
    DenoisedColour denoised_colour_;
    BackgroundState set_;
    int learnt_instants_ = 0;
    std::optional<Model> model_;
    std::optional<double> shape_made_s_;
    std::deque<SharedBytes> right_jpegs_;
    std::optional<Match> match_;
    DrawnTexture matched_depth_{TextureFormat::r32f};
    DrawnTexture matte_{TextureFormat::r8, Filter::linear};
    DrawnTexture matte_tiles_{TextureFormat::r8};
    DrawnTexture foreground_depth_{TextureFormat::r32f};
    bool is_colour_denoised_ = false, is_background_learnt_ = false;
    std::shared_ptr<const RigSurface> surface_, performers_;
    std::optional<int> prepared_rank_;
    float presence_ = 1;
    SurfaceSamples samples_;
};

}  // namespace vantage

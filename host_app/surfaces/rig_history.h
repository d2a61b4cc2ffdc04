#pragma once

#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/surfaces/rig_surface.h"

namespace vantage {

/// GPU state of temporal denoising: the denoised picture (rgba8, with mip levels) and the mean
/// (rgba16f). The old copies of both are read while the new ones are drawn. The mean's alpha counts
/// its instants and falls where the picture changes.
class DenoisedColour {
  public:
    /// Whether picture() and mean() hold anything.
    bool is_drawn() const { return is_drawn_; }
    const Texture& picture() const { return sized_->pictures[sized_->now]; }
    const Texture& mean() const { return sized_->means[sized_->now]; }

    /// Starts again if the size changes.
    void resize(cv::Size size) {
        if (sized_ && sized_->pictures[0].size() == size) return;
        sized_.emplace(size);
        is_drawn_ = false;
    }
    /// Continues from a mean that was read back: rgba16f, of the same size.
    void restore(const cv::Mat& mean) {
        sized_->means[sized_->now].upload(mean);
        is_drawn_ = true;
    }
    /// The target of the next draw: the picture and the new mean.
    const Framebuffer& next_target(cv::Size size) {
        resize(size);
        return sized_->targets[1 - sized_->now];
    }
    void finish() {
        sized_->now = 1 - sized_->now;
        is_drawn_ = true;
    }
    void generate_mipmaps() { sized_->pictures[sized_->now].generate_mipmaps(); }
    void forget() { is_drawn_ = false; }

  private:
    struct Sized {
        std::array<Texture, 2> pictures, means;
        std::array<Framebuffer, 2> targets;
        std::size_t now = 0;

        explicit Sized(cv::Size size)
            : pictures{picture_of(size), picture_of(size)},
              means{mean_of(size), mean_of(size)},
              targets{Framebuffer{&pictures[0], &means[0]}, Framebuffer{&pictures[1], &means[1]}} {}
        static Texture picture_of(cv::Size size) {
            return {TextureFormat::rgba8, size.width, size.height, Filter::linear, true};
        }
        static Texture mean_of(cv::Size size) {
            return {TextureFormat::rgba16f, size.width, size.height, Filter::linear};
        }
    };

    std::optional<Sized> sized_;
    bool is_drawn_ = false;
};

/// GPU state of a rig's background depth: the state (rgba32f, see background_learn.frag; red is the
/// depth in metres), of which the old copy is read while the new one is drawn, and the kinds of the
/// newest instant's pixels (rgba8, see background_compare.frag).
class BackgroundState {
  public:
    /// Whether state() and seen() hold anything.
    bool is_drawn() const { return is_drawn_; }
    const Texture& state() const { return sized_->states[sized_->now]; }
    const Texture& seen() const { return seen_.texture(); }

    /// Starts again if the size changes.
    void resize(cv::Size size) {
        if (sized_ && seen().size() == size) return;
        seen_.resize(size);
        sized_.emplace(size);
        is_drawn_ = false;
    }
    const Framebuffer& seen_target() const { return seen_.target(); }
    const Framebuffer& next_target() const { return sized_->targets[1 - sized_->now]; }
    /// Continues from a state that was read back: rgba32f, of the same size.
    void restore(const cv::Mat4f& state) {
        sized_->states[sized_->now].upload(state);
        is_drawn_ = true;
    }
    void finish() {
        sized_->now = 1 - sized_->now;
        is_drawn_ = true;
    }
    void forget() { is_drawn_ = false; }

  private:
    struct Sized {
        std::array<Texture, 2> states;
        std::array<Framebuffer, 2> targets;
        std::size_t now = 0;

        explicit Sized(cv::Size size)
            : states{state_of(size), state_of(size)},
              targets{Framebuffer{&states[0]}, Framebuffer{&states[1]}} {}
        static Texture state_of(cv::Size size) {
            return {TextureFormat::rgba32f, size.width, size.height};
        }
    };

    DrawnTexture seen_{TextureFormat::rgba8, Filter::nearest, false, DrawnWith::depth_test};
    std::optional<Sized> sized_;
    bool is_drawn_ = false;
};

/// Time between two instants, if the caller does not give it.
inline constexpr double nominal_dt_s = 1.0 / 30;

/// One rig as the preparer of instants keeps it from instant to instant: its newest picture and
/// depth on the GPU, its background and its last published surfaces. Textures are kept while the
/// sizes stay. Belongs to the preparer's thread and GL context.
class RigHistory {
  public:
    /// Uploads a view that was filmed `dt_s` after the one before. A different camera or size
    /// forgets the history. Precondition: the view has depth.
    void upload(const DepthView& view, double dt_s = nominal_dt_s);
    /// Forgets all that was learnt, and hides the rig.
    void forget();
    /// Drops the published surfaces.
    void hide();

    /// Camera and name of the last upload, without pictures.
    const DepthView& camera() const { return camera_; }
    const Texture& depth() const { return depth_.texture(); }  ///< r32f, metres, 0 = unknown
    /// rgba8: after finish_colour() the denoised colour of this upload, with mip levels; before it
    /// fresh_colour(), without.
    const Texture& colour() const {
        return is_colour_denoised_ ? denoised_colour_.picture() : fresh_colour();
    }
    const Texture& fresh_colour() const { return *colour_; }
    bool has_colour_before() const { return denoised_colour_.is_drawn(); }
    /// The temporal mean; after finish_colour() that of this upload. Precondition:
    /// has_colour_before().
    const Texture& colour_mean() const { return denoised_colour_.mean(); }
    /// The denoised picture that belongs to colour_mean(). Precondition: has_colour_before().
    const Texture& denoised_colour() const { return denoised_colour_.picture(); }
    const Framebuffer& next_colour_target() {
        return denoised_colour_.next_target(colour_->size());
    }
    void finish_colour() {
        denoised_colour_.finish();
        is_colour_denoised_ = true;
    }
    /// To be called before the denoised picture is read at coarser levels.
    void generate_mipmaps() { denoised_colour_.generate_mipmaps(); }
    /// The background's depth in the first channel; depth() if this upload was not learnt.
    const Texture& steady_depth() const {
        return is_background_learnt_ ? background_.state() : depth();
    }
    const BackgroundState& background_state() const { return background_; }
    BackgroundState& background_to_learn() {
        background_.resize(depth().size());
        return background_;
    }
    void finish_background() {
        background_.finish();
        is_background_learnt_ = true;
        ++learnt_instants_;
    }
    /// Begins with a saved background: the states of depth and colour.
    void restore(const cv::Mat4f& background_state, const cv::Mat& colour_mean, int instants) {
        background_.resize(depth().size());
        background_.restore(background_state);
        denoised_colour_.resize(colour_->size());
        denoised_colour_.restore(colour_mean);
        learnt_instants_ = instants;
    }
    /// Instants that the background was learnt from.
    int learnt_instants() const { return learnt_instants_; }
    /// The background after its last refinement.
    struct Model {
        std::shared_ptr<const RigSurface> surface;
        int rank = 0;       ///< PrepareLevel::rank of the refinement; lower is better
        double rest_s = 0;  ///< time before a new refinement can gain anything
        double made_s = 0;  ///< on the preparer's clock
        int made = 0;       ///< learnt_instants() by then
        int matches = 0;    ///< matches() of the rig by then
        /// steady_depth() and colour() by then.
        std::shared_ptr<const DrawnTexture> learnt_m = nullptr, colour = nullptr;
    };
    /// Nothing before the first refinement.
    const std::optional<Model>& model() const { return model_; }
    void set_background_model(const Model& model) { model_ = model; }

    /// The newest right images, the oldest first.
    const std::deque<SharedBytes>& right_jpegs() const { return right_jpegs_; }

    /// The depth of the background from background stereo (see match_backgrounds()).
    struct Match {
        Texture depth_m;           ///< r32f, metres, 0 = unknown
        Texture learnt_m, colour;  ///< r32f and rgba8: the background at that time
    };
    const std::optional<Match>& match() const { return match_; }
    /// Runs of background stereo that gave this rig a depth.
    int matches() const { return matches_; }
    /// All three have one size: that of depth() or smaller.
    void set_background_match(const DepthImage& depth_m, const DepthImage& learnt_m,
                              const ColourImage& colour);
    /// The background's depth, from the match where it still applies.
    DrawnTexture& matched_depth() { return matched_depth_; }

    /// The matte of the foreground (r8), and the tiles of the picture with foreground (see
    /// TilePass).
    DrawnTexture& matte() { return matte_; }
    const Texture& matte() const { return matte_.texture(); }
    DrawnTexture& matte_tiles() { return matte_tiles_; }
    const Texture& matte_tiles() const { return matte_tiles_.texture(); }
    /// Depth of the foreground: r32f, metres, 0 = none, negative beyond the matte.
    DrawnTexture& foreground_depth() { return foreground_depth_; }
    const Texture& foreground_depth() const { return foreground_depth_.texture(); }

    /// Time since the last upload that was learnt, s.
    double dt_s() const { return dt_s_; }

    /// The surfaces that were published last, and the PrepareLevel::rank of those of the last
    /// upload (lower is better); nothing if it was not published.
    const std::shared_ptr<const RigSurface>& surface() const { return surface_; }
    const std::shared_ptr<const RigSurface>& performers() const { return performers_; }
    std::optional<int> prepared_rank() const { return prepared_rank_; }
    /// The picture of the last upload, denoised; null if it was not made.
    const std::shared_ptr<const DrawnTexture>& picture_now() const { return picture_now_; }
    void set_picture_now(std::shared_ptr<const DrawnTexture> picture) {
        picture_now_ = std::move(picture);
    }
    void publish(std::shared_ptr<const RigSurface> surface,
                 std::shared_ptr<const RigSurface> performers, int rank) {
        surface_ = std::move(surface);
        performers_ = std::move(performers);
        prepared_rank_ = rank;
    }
    /// Weight of the rig in the picture, 0..1.
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
    std::unique_ptr<ColourCorrector> corrector_;  ///< null until a view needs it
    std::unique_ptr<DepthUploader> uploader_;     ///< likewise
    DenoisedColour denoised_colour_;
    BackgroundState background_;
    int learnt_instants_ = 0;
    std::optional<Model> model_;
    std::deque<SharedBytes> right_jpegs_;
    std::optional<Match> match_;
    int matches_ = 0;
    DrawnTexture matched_depth_{TextureFormat::r32f};
    DrawnTexture matte_{TextureFormat::r8, Filter::linear};
    DrawnTexture matte_tiles_{TextureFormat::r8};
    DrawnTexture foreground_depth_{TextureFormat::r32f};
    bool is_colour_denoised_ = false, is_background_learnt_ = false;
    std::shared_ptr<const RigSurface> surface_, performers_;
    std::shared_ptr<const DrawnTexture> picture_now_;
    std::optional<int> prepared_rank_;
    float presence_ = 1;
    SurfaceSamples samples_;
};

/// Time in which a rig fades in or out, s: short, but no visible jump.
inline constexpr double fade_s = 1.0 / 6;

/// The rigs of a stage, by name. A rig that disappears keeps its background until it comes back.
/// Belongs to the preparer's thread and GL context.
class RigRoster {
  public:
    /// Uploads the views of an instant that have depth, filmed `dt_s` after the one before, and
    /// returns their rigs. A rig that appears fades in; a rig that is missing fades out with its
    /// last surfaces. If no view belongs to a known rig, all rigs are replaced.
    std::vector<RigHistory*> upload(std::span<const DepthView> views, double dt_s);
    /// Hides all rigs at once, also those that are fading.
    void cut();
    /// Forgets all that was learnt of all rigs.
    void forget();
    /// Destroys the rigs that are not named here, except those that are shown. Returns whether
    /// there were any.
    bool keep_only(const std::set<std::string>& names);

    /// The rigs of the last upload and those that are fading out.
    const std::vector<RigHistory*>& shown() const { return shown_; }
    /// All rigs, also those that are away.
    std::vector<RigHistory*> known() const;
    /// Whether `rig` is one of them and has a background.
    bool has_learnt(const RigHistory* rig) const;

  private:
    std::vector<std::unique_ptr<RigHistory>> rigs_;
    std::vector<RigHistory*> shown_;
};

}  // namespace vantage

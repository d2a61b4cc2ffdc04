#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "host_app/instants/depth_uploader.h"
#include "host_app/instants/rig_surface.h"
#include "host_app/instants/steady_colour.h"

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

    /// Camera, name and sizes as in the last upload; its pictures are empty.
    const DepthView& camera() const { return camera_; }
    const Texture& depth() const { return depth_.texture(); }  ///< r32f, metres, 0 = unknown
    /// rgba8: fresh_colour(), without mip levels, or, trilinear, what finish_colour() saw drawn of
    /// it since.
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
    /// depth() filtered along time, with a second channel of the filter's own: what
    /// finish_steady_depth() saw drawn last into next_steady_target(). depth() itself where nothing
    /// was.
    const Texture& steady_depth() const { return is_depth_steady_ ? steady_.texture() : depth(); }
    bool has_steady_before() const { return steady_.is_drawn(); }
    /// Precondition: has_steady_before().
    const Texture& steady_before() const { return steady_.texture(); }
    const Framebuffer& next_steady_target() { return steady_.next_target(depth().size()); }
    void finish_steady_depth() {
        steady_.finish();
        is_depth_steady_ = true;
    }

    /// Since the upload before.
    double dt_s() const { return dt_s_; }

    /// What was published of this rig last, and whether it was made of the last upload and how well
    /// (see PrepareLevel::rank; lower is better).
    const std::shared_ptr<const RigSurface>& surface() const { return surface_; }
    std::optional<int> prepared_rank() const { return prepared_rank_; }
    void publish(std::shared_ptr<const RigSurface> surface, int rank) {
        if (!prepared_rank_) before_ = std::move(surface_);
        surface_ = std::move(surface);
        prepared_rank_ = rank;
    }
    /// What was published of the upload before, with settled depth; null: nothing was.
    const RigSurface* settled_before() const {
        const RigSurface* before = prepared_rank_ ? before_.get() : surface_.get();
        return before && before->is_settled() ? before : nullptr;
    }

    /// What this rig has learnt of its background, and of how many instants; null before the first.
    const std::shared_ptr<RigPlate>& plate() const { return plate_; }
    int plate_instants() const { return plate_instants_; }
    void learn(std::shared_ptr<RigPlate> plate) {
        plate_ = std::move(plate);
        ++plate_instants_;
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
    DrawnInTurn steady_{TextureFormat::rg32f};
    SteadyColour steady_colour_;
    bool is_colour_steady_ = false, is_depth_steady_ = false;
    std::shared_ptr<const RigSurface> surface_, before_;
    std::optional<int> prepared_rank_;
    float presence_ = 1;
    std::shared_ptr<RigPlate> plate_;
    int plate_instants_ = 0;
    SurfaceSamples samples_;
};

}  // namespace vantage

#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host_app/background/background_model.h"
#include "host_app/background/background_stereo_task.h"
#include "host_app/foreground/foreground_depth.h"
#include "host_app/fused/background_baker.h"
#include "host_app/pipeline/instant_preparer.h"
#include "host_app/refine/depth_inpainting.h"
#include "host_app/refine/edge_confidence.h"
#include "host_app/refine/multi_view_refinement.h"
#include "host_app/surfaces/recycle_pool.h"
#include "host_app/surfaces/rig_history.h"
#include "host_app/surfaces/rig_surface.h"

namespace vantage {

/// Share of the Laplacian by which images are sharpened once per instant for the levels that
/// interpolate them bilinearly. 1/12 makes up for the mean variance of that interpolation, and the
/// rest for a virtual camera that stands nearer than the rigs, whose pixels show less of a surface.
inline constexpr float bilinear_sharpening = 0.22f;

/// The product's preparer. It separates the stage into a background, which is learnt over time,
/// refined by all rigs and kept, and a foreground, which a matte cuts out of every instant.
class StagedPreparer final : public InstantPreparer, private BackgroundAccess {
  public:
    explicit StagedPreparer(const ShaderLibrary& library);

    void take(std::span<const DepthView> views, double dt_s) override;
    std::shared_ptr<const Instant> prepare(const VirtualView& target,
                                           const PrepareLevel& level) override;
    void improve(const VirtualView& target) override;
    bool improve_a_step(const VirtualView& target) override {
        return improve_a_step(target, BackgroundStereoTask::Manner::beside);
    }
    bool is_improvement_urgent() const override { return baker_.is_first_under_way(); }
    void warm_up(std::span<const DepthView> views, const VirtualView& target) override;
    void cut() override;
    void keep_only(const std::set<std::string>& rigs) override;
    BackgroundAccess* background_access() override { return this; }

  private:
    void begin_with(std::shared_ptr<const Background> set) override;
    void learn_anew() override;
    Background learnt() const override;
    std::vector<RigBackgroundState> states() const override { return states_; }

    /// Learns the backgrounds of those of the newest instant's rigs that were not learnt yet.
    void learn(std::span<RigHistory* const> rigs);
    /// Returns the newest instant's rigs whose background is learnt at levels that do not need all:
    /// those that were prepared last, and the one that was learnt longest ago.
    std::vector<RigHistory*> rigs_in_turn() const;
    /// Lets a rig without a past begin with the loaded background if it fits.
    void begin_with_learnt(RigHistory& rig);
    void look_at_sets();
    /// Makes a rough model of one rig that is learnt well enough for its background to be baked and
    /// has no model of that yet, or one of so few instants that it pays to make another.
    void make_a_first_model();
    /// A background model that is refined in steps between instants.
    struct Refining {
        struct Rig {
            RigHistory* rig = nullptr;
            cv::Size colour, depth;
            bool is_matched = false;
        };
        std::vector<Rig> rigs;  ///< the rigs it needs, with their sizes
        std::deque<MultiViewRefinement::Step> steps;
    };
    void begin_refining(const VirtualView& target);
    /// Whether all rigs that it needs are unchanged.
    bool is_under_way(const Refining& refining) const;
    std::shared_ptr<const DrawnTexture> copy_of(const Texture& texture, TextureFormat format);
    /// Returns the depth of a rig's background model, with the learnt depth where the background
    /// has changed since.
    const Texture& patched_model(const RigHistory& rig);
    /// The steps of make_model(). The rigs must not change until the last step.
    std::deque<MultiViewRefinement::Step> model_in_steps(RigHistory& rig,
                                                         const PrepareLevel& level);
    /// Makes the rig's background model anew; a level that is not refined patches a refined one.
    void make_model(RigHistory& rig, const PrepareLevel& level);
    /// Returns the rig's background depth, refined by the other rigs.
    const Texture& refined_background(RigHistory& rig);
    /// A run of background stereo: the rigs' backgrounds are read back one by one, matched against
    /// each other on another thread, and taken over.
    struct Matched {
        std::vector<RigHistory*> rigs;
        std::vector<BackgroundView> sets;   ///< read back so far
        std::vector<cv::Size> depth_sizes;  ///< likewise
    };
    /// Does a step of background stereo if one is due. Returns true if more is left to read back.
    bool match_a_step(BackgroundStereoTask::Manner manner);
    /// improve_a_step() with the manner in which background stereo runs.
    bool improve_a_step(const VirtualView& target, BackgroundStereoTask::Manner manner);
    /// Has the rig's background model made anew as soon as there is time.
    static void make_model_due(RigHistory& rig);
    void take_match(std::span<const DepthImage> depths_m);
    /// Discards the run in progress. The next one begins at `due_s` on now_s_'s clock.
    void match_anew(double due_s);
    /// Does a step of baking if one is due. Returns true if more are.
    bool bake_a_step(const VirtualView& target, BackgroundStereoTask::Manner manner);
    std::shared_ptr<const RigSurface> performers_of(RigHistory& rig, const PrepareLevel& level);
    std::shared_ptr<const RigSurface> set_of(RigHistory& rig, const Texture& performers_m,
                                             const PrepareLevel& level);
    void make_shape(RigSurface& surface, RigHistory& rig, const Texture& performers_m,
                    const PrepareLevel& level);
    void publish(RigHistory& rig, const PrepareLevel& level);
    /// Returns the rig's picture at the newest instant, denoised where it shows the background.
    std::shared_ptr<const DrawnTexture> picture_now(RigHistory& rig);

    RecyclePool<RigSurface> surfaces_;
    RecyclePool<DrawnTexture> pictures_;
    std::shared_ptr<RigSurface::Shapes> shapes_ = std::make_shared<RigSurface::Shapes>();
    RigRoster rigs_;
    std::vector<RigHistory*> uploaded_;    ///< the newest instant's rigs
    std::vector<RigHistory*> learnt_;      ///< those of them whose background was learnt
    std::set<RigHistory*> has_depths_;     ///< those whose foreground depth was computed
    PrepareLevel level_;                   ///< of the last prepared instant
    std::set<RigHistory*> prepared_rigs_;  ///< for that instant
    std::optional<Refining> refinement_pass_;
    std::optional<Matched> matched_;
    BackgroundStereoTask matching_;
    double match_due_s_ = 0, match_rest_s_ = 0;
    MatchedSize matched_size_ = MatchedSize::half;  ///< of the run in progress or the next one
    BackgroundModel sets_;
    ForegroundDepth performers_;
    MultiViewRefinement refinement_;
    DepthInpainting inpainting_;
    EdgeConfidence edge_confidence_;
    TriangleBuilder triangles_;
    FullscreenPass show_, now_, show_matched_;
    TilePass colour_performers_;
    FullscreenPass copy_, patch_, picture_now_;
    DrawnTexture patched_{TextureFormat::r32f};
    BackgroundBaker baker_;
    bool is_baked_ = false;  ///< the present instant is drawn from what baker_ has
    /// The next instant is shown as early as possible: rigs that it does not show are learnt later.
    bool is_after_cut_ = false;
    double now_s_ = 0;  ///< time of the newest instant since the first one
    double improved_s_ = 0;
    std::shared_ptr<const Background> begins_with_;
    std::map<std::string, std::string>
        misfits_;  ///< why the loaded background does not fit, by rig
    std::vector<RigBackgroundState> states_;
    double looked_s_ = 0;
};

}  // namespace vantage

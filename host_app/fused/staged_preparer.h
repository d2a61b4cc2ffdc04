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
#include "host_app/pipeline/instant_preparer.h"
#include "host_app/refine/depth_inpainting.h"
#include "host_app/refine/edge_confidence.h"
#include "host_app/refine/multi_view_refinement.h"
#include "host_app/surfaces/recycle_pool.h"
#include "host_app/surfaces/rig_roster.h"
#include "host_app/surfaces/triangle_builder.h"

namespace vantage {

/// Takes a stage for two things: a set, which is learnt along time, bettered by all rigs and kept,
/// and performers before it, who are cut out of every instant with a matte.
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
    void warm_up(std::span<const DepthView> views, const VirtualView& target) override;
    void cut() override;
    BackgroundAccess* background_access() override { return this; }

  private:
    void begin_with(std::shared_ptr<const Background> set) override;
    void learn_anew() override;
    Background learnt() const override;
    std::vector<RigBackgroundState> states() const override { return states_; }

    /// The sets of those rigs of the newest instant of which it was not done yet.
    void learn(std::span<RigHistory* const> rigs);
    /// Of the newest instant, at levels that do not need all: those that were prepared last, and of
    /// the others the one whose set was learnt longest ago.
    std::vector<RigHistory*> rigs_in_turn() const;
    /// A rig without a past begins with what was loaded of it, if that fits.
    void begin_with_learnt(RigHistory& rig);
    void look_at_sets();
    /// A model that is made a step at a time, between instants.
    struct Refining {
        struct Rig {
            RigHistory* rig = nullptr;
            cv::Size colour, depth;
            bool is_matched = false;
        };
        std::vector<Rig> rigs;  ///< that it needs, of these sizes
        std::deque<MultiViewRefinement::Step> steps;
    };
    void begin_refining(const VirtualView& target);
    /// Whether all that it needs is still as it was.
    bool is_under_way(const Refining& refining) const;
    /// What make_model() does. The rigs must stay what they are until the last step.
    std::deque<MultiViewRefinement::Step> model_in_steps(RigHistory& rig, const PrepareLevel& level);
    /// Makes the model of the rig's set anew.
    void make_model(RigHistory& rig, const PrepareLevel& level);
    /// The depth of the rig's set as the other rigs better it.
    const Texture& refined_background(RigHistory& rig);
    /// Sets that are to be matched against each other: read back rig by rig, matched, and taken
    /// over.
    struct Matched {
        std::vector<RigHistory*> rigs;
        std::vector<BackgroundView> sets;       ///< of the first of them
        std::vector<cv::Size> depth_sizes;  ///< likewise
    };
    /// A step of that, if it is time. True: more of them is left to be read back.
    bool match_a_step(BackgroundStereoTask::Manner manner);
    /// As without `manner`, in which sets are matched.
    bool improve_a_step(const VirtualView& target, BackgroundStereoTask::Manner manner);
    void take_match(std::span<const DepthImage> depths_m);
    /// What is under way is of no use any more; the next one begins then, on now_s_'s clock.
    void match_anew(double due_s);
    std::shared_ptr<const RigSurface> performers_of(RigHistory& rig, const PrepareLevel& level);
    std::shared_ptr<const RigSurface> set_of(RigHistory& rig, const Texture& performers_m,
                                             const PrepareLevel& level);
    /// Whether at this level the shape of the rig's set is not made anew for every instant, and
    /// that of the last one will do.
    bool has_shape(const RigHistory& rig, const PrepareLevel& level) const;
    void make_shape(RigSurface& surface, RigHistory& rig, const Texture& performers_m,
                    const PrepareLevel& level);
    void publish(RigHistory& rig, const PrepareLevel& level);

    RecyclePool<RigSurface> surfaces_;
    std::shared_ptr<RigSurface::Shapes> shapes_ = std::make_shared<RigSurface::Shapes>();
    RigRoster rigs_;
    std::vector<RigHistory*> uploaded_;    ///< those of the newest instant
    std::vector<RigHistory*> learnt_;      ///< of them: whose sets were learnt
    std::set<RigHistory*> has_depths_;     ///< of them: whose performers were found
    PrepareLevel level_;                   ///< of the last instant that was prepared
    std::set<RigHistory*> prepared_rigs_;  ///< for it
    std::optional<Refining> refinement_pass_;
    std::optional<Matched> matched_;
    BackgroundStereoTask matching_;
    double match_due_s_ = 0, match_rest_s_ = 0;
    BackgroundModel sets_;
    ForegroundDepth performers_;
    MultiViewRefinement refinement_;
    DepthInpainting inpainting_;
    EdgeConfidence edge_confidence_;
    TriangleBuilder triangles_;
    FullscreenPass show_, now_, show_matched_;
    TilePass colour_performers_;
    /// The next instant is shown as soon as can be: rigs that it does not show are left for later.
    bool is_after_cut_ = false;
    double now_s_ = 0;  ///< instants' time since the first one
    double improved_s_ = 0;
    std::shared_ptr<const Background> begins_with_;
    std::map<std::string, std::string> misfits_;  ///< by rig that begins_with_ was tried for
    std::vector<RigBackgroundState> states_;
    double looked_s_ = 0;
};

}  // namespace vantage

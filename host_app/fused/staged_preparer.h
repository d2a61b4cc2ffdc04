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
#include "host_app/baked/baked_background.h"
#include "host_app/foreground/foreground_depth.h"
#include "host_app/pipeline/instant_preparer.h"
#include "host_app/refine/depth_inpainting.h"
#include "host_app/refine/edge_confidence.h"
#include "host_app/refine/multi_view_refinement.h"
#include "host_app/surfaces/recycle_pool.h"
#include "host_app/surfaces/rig_roster.h"
#include "host_app/surfaces/triangle_builder.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {

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
    void warm_up(std::span<const DepthView> views, const VirtualView& target) override;
    void cut() override;
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
    /// The steps of make_model(). The rigs must not change until the last step.
    std::deque<MultiViewRefinement::Step> model_in_steps(RigHistory& rig,
                                                         const PrepareLevel& level);
    /// Makes the rig's background model anew.
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
    /// One view of the baked background, made anew when a background model has changed.
    struct Probe {
        VirtualView view;
        std::shared_ptr<const BackgroundProbe> made;
        double made_s = -1;  ///< on now_s_'s clock; negative: not yet
    };
    /// A rig's background model as a surface that can be rendered.
    struct ModelSurface {
        std::shared_ptr<const RigSurface> model, surface;
    };
    /// Renders or takes over one probe if one is due. Returns true if more are.
    bool bake_a_step(const VirtualView& target);
    std::vector<Probe*> nearest_first(const VirtualView& target);
    /// Whether the probes that a view from here is drawn from have been made.
    bool are_probes_made(const VirtualView& target);
    void place_probes(std::span<RigHistory* const> rigs);
    std::shared_ptr<const RigSurface> model_surface(RigHistory& rig);
    std::shared_ptr<const RigSurface> performers_of(RigHistory& rig, const PrepareLevel& level);
    std::shared_ptr<const RigSurface> set_of(RigHistory& rig, const Texture& performers_m,
                                             const PrepareLevel& level);
    /// Whether the background's shape of the last instant is reused at this level.
    bool has_shape(const RigHistory& rig, const PrepareLevel& level) const;
    void make_shape(RigSurface& surface, RigHistory& rig, const Texture& performers_m,
                    const PrepareLevel& level);
    void publish(RigHistory& rig, const PrepareLevel& level);

    RecyclePool<RigSurface> surfaces_;
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
    BackgroundModel sets_;
    ForegroundDepth performers_;
    MultiViewRefinement refinement_;
    DepthInpainting inpainting_;
    EdgeConfidence edge_confidence_;
    TriangleBuilder triangles_;
    FullscreenPass show_, now_, show_matched_;
    TilePass colour_performers_;
    FullscreenPass learnt_colours_, copy_;
    std::unique_ptr<ViewRenderer> probe_renderer_;
    std::vector<Probe> probes_;
    std::vector<DepthView> probe_cameras_;          ///< of the rigs that they were placed for
    std::map<std::string, ModelSurface> modelled_;  ///< by rig
    const Texture* probe_picture_ = nullptr;
    Probe* rendered_ = nullptr;  ///< the probe that probe_renderer_ has
    double parallax_px_m_ = 0;
    std::shared_ptr<const InstantExtra> baked_;  ///< null until the first probe is made
    bool is_background_still_ = true;            ///< nothing that the probes lack
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

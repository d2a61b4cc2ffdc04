#pragma once

#include <future>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/gl/objects/fence.h"
#include "host_app/baked/background_probe.h"
#include "host_app/baked/probe_surface.h"
#include "host_app/refine/edge_confidence.h"
#include "host_app/surfaces/rig_history.h"
#include "host_app/surfaces/rig_surface.h"
#include "host_app/synthesis/rig_layers.h"

namespace vantage {

/// Bakes the background: draws it from a few places between the rigs (probes) once per change of
/// the rigs' background models, in steps of a few milliseconds, and divides each view into tiles on
/// a thread of its own. Belongs to the preparer's thread and context.
class BackgroundBaker {
  public:
    explicit BackgroundBaker(const ShaderLibrary& library);

    /// Does a step of baking for these rigs, each with a background model, if a probe is due; those
    /// beside `target` come first. With `waits`, waits for the other thread. Returns true if more
    /// steps of the same probe are left.
    bool step(std::span<RigHistory* const> rigs, const VirtualView& target, double now_s,
              bool waits);
    /// Whether a probe is being drawn for a place that nothing is baked for yet.
    bool is_first_under_way() const { return drawing_ && !is_current(probes_[drawing_->probe]); }
    /// Bakes for newer models as soon as there are some, and draws what was baked before until
    /// then.
    void bake_anew();
    /// The background has changed: what was baked before of refined models is not drawn any more.
    void note_change(double now_s);
    /// Returns what `target` is drawn from; null while too many of the probes around it are
    /// missing or older than a change.
    std::shared_ptr<const BakedExtra> baked_for(const VirtualView& target) const;
    /// Returns a rig's background model as a surface that does not change until the model does,
    /// with the learnt colours. Precondition: the rig has a model.
    std::shared_ptr<const RigSurface> surface_of(const RigHistory& rig);
    void forget();
    /// Destroys what was baked before and no instant holds any more. Instants end on any thread,
    /// and GL objects only on this one.
    void release_unused();

  private:
    struct Probe {
        VirtualView view;
        std::shared_ptr<const BackgroundProbe> made;
        double made_s = 0;     ///< when its baking began, on the preparer's clock
        double rest_s = 0;     ///< time before it is baked again
        bool is_rough = true;  ///< not all models were refined by then
        int matches = 0;       ///< the sum of the models' RigHistory::Model::matches by then
    };
    struct ModelSurface {
        std::shared_ptr<const RigSurface> model, surface;
        std::shared_ptr<const BackgroundPicture> picture;  ///< of the surface; null until needed
    };
    /// A probe that is being drawn.
    struct Drawing {
        std::size_t probe = 0;
        std::vector<std::string> rigs;
        std::vector<std::shared_ptr<const RigSurface>> surfaces;  ///< of the first rigs so far
        std::size_t drawn = 0;                                    ///< of the surfaces
        double begun_s = 0;
        bool is_rough = true;  ///< not all models are refined
        int matches = 0;       ///< the sum of the models' RigHistory::Model::matches
    };

    /// Keeps a probe that was replaced until release_unused().
    void retire(std::shared_ptr<const BackgroundProbe> probe);
    void place_probes(std::span<RigHistory* const> rigs);
    /// Returns the probes in the order of their ways to a view.
    std::vector<std::size_t> nearest_first(const VirtualView& view) const;
    /// Rough models still change while the background is being learnt: their probes are drawn until
    /// there are newer ones.
    bool is_current(const Probe& probe) const {
        return probe.made && (probe.is_rough || probe.made_s >= changed_s_);
    }
    /// Begins to draw the probe that is due first, if any.
    void begin(std::span<RigHistory* const> rigs, const VirtualView& target, double now_s);
    /// Does the next step of drawing. Returns false if it was the last one.
    bool draw(std::span<RigHistory* const> rigs);
    /// Has the GPU draw every rig's surface at each pixel of the probe (probe_surface()'s
    /// candidates).
    void draw_candidates();
    /// Reads the candidates back, and on another thread chooses surfaces and divides them into
    /// tiles.
    void choose();
    void take_over(const ProbeTiles& tiles);
    /// Reads a rig's background back, once per model.
    std::shared_ptr<const BackgroundPicture> picture_of(const std::string& rig);

    RigLayers layers_;
    LayerPass candidates_pass_;
    DrawnTexture candidates_m_{TextureFormat::rgba32f};
    EdgeConfidence edge_confidence_;
    TriangleBuilder triangles_;
    FullscreenPass learnt_colours_;
    RecyclePool<RigSurface> surfaces_;
    std::shared_ptr<RigSurface::Shapes> shapes_ = std::make_shared<RigSurface::Shapes>();
    std::map<std::string, ModelSurface> modelled_;  ///< by rig
    std::vector<ProbeRig> placed_for_;
    std::vector<Probe> probes_;
    std::vector<std::shared_ptr<const BackgroundProbe>> retired_;
    double parallax_px_m_ = 0;
    double changed_s_ = -1;
    std::optional<Drawing> drawing_;
    std::optional<Drawing> on_gpu_;  ///< the GPU draws its candidates
    Fence candidates_drawn_;
    /// The thread of tiles_ makes its tiles; empty: nobody wants them.
    std::optional<Drawing> on_thread_;
    std::future<ProbeTiles> tiles_;
    std::shared_ptr<const BakedExtra> baked_;  ///< null until the first probe is made
};

}  // namespace vantage

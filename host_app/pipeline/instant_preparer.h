#pragma once

#include <set>
#include <span>
#include <string>

#include "host_app/background/background_access.h"
#include "host_app/surfaces/instant.h"
#include "host_app/surfaces/recycle_pool.h"
#include "host_app/surfaces/rig_surface.h"
#include "host_app/views/depth_view.h"

namespace vantage {

/// A quality level of instant preparation and so its cost. The governor moves along
/// prepare_levels().
struct PrepareLevel {
    int rank = 0;  ///< 0 is the best; a higher rank costs less
    std::size_t rigs = most_drawn_rigs;
    /// The foreground's depth is compared with the other rigs: depth that they see through is
    /// carved away, and depth is moved to where the rigs' images match.
    bool is_refined = true;
    bool has_fine_grid = true;  ///< surfaces may be drawn with one vertex per pixel, with rims
    float bend = TriangleBuilder::default_bend;  ///< least bend that splits a cell of a coarse grid
};

/// All preparation levels from the best to the cheapest, ordered by rank.
std::span<const PrepareLevel> prepare_levels();

/// Turns the rigs' depth views into instants on the GPU. Belongs to one thread and to the context
/// that was current at construction. Subclasses keep what they learn over time; times are in
/// seconds.
class InstantPreparer {
  public:
    virtual ~InstantPreparer() = default;

    /// Uploads the views of the next instant, exposed `dt_s` after the one before, and learns from
    /// them. Views may differ in size and may lack depth; there may be one view or none.
    virtual void take(std::span<const DepthView> views, double dt_s) = 0;

    /// Returns the last taken instant, ready to be rendered from `target` and nearby. May be called
    /// again for another target or a better level.
    virtual std::shared_ptr<const Instant> prepare(const VirtualView& target,
                                                   const PrepareLevel& level) = 0;

    /// Refines what later instants are made from, as far as rendering from `target` needs it, until
    /// nothing is left to do. Waits for work that runs on a thread of its own.
    virtual void improve(const VirtualView& target) {
        while (improve_a_step(target)) continue;
    }
    /// Does one step of improve(), about as long as one pass takes. Returns true if more steps of
    /// the same work are left.
    virtual bool improve_a_step(const VirtualView& /*target*/) { return false; }
    /// Whether the steps under way make every later picture much cheaper, so that an instant may
    /// wait for them.
    virtual bool is_improvement_urgent() const { return false; }

    /// Runs every pass that these views may ever need and learns nothing: a driver compiles a
    /// shader when it is first used, which takes seconds for all of them. Precondition: nothing was
    /// taken yet, or it may be forgotten.
    virtual void warm_up(std::span<const DepthView> /*views*/, const VirtualView& /*target*/) {}

    /// Announces that the next instant does not follow the last one (a cut). Forgets what was
    /// tracked of moving things and keeps the background.
    virtual void cut() {}

    /// Forgets the rigs that are not named here, once they are not shown any more: they were
    /// removed from the stage.
    virtual void keep_only(const std::set<std::string>& /*rigs*/) {}

    /// Returns access to the learnt background, or null if the preparer learns none.
    virtual BackgroundAccess* background_access() { return nullptr; }
};

/// Prepares the rigs' images and depth maps unchanged and triangulates their grids.
class PlainPreparer final : public InstantPreparer {
  public:
    /// `takes_all` also takes views without depth; their surfaces are one pixel of unknown depth.
    explicit PlainPreparer(const ShaderLibrary& library, bool takes_all = false)
        : triangles_(library), takes_all_(takes_all) {}

    void take(std::span<const DepthView> views, double dt_s) override;
    std::shared_ptr<const Instant> prepare(const VirtualView& target,
                                           const PrepareLevel& level) override;

  private:
    RecyclePool<RigSurface> surfaces_;
    std::unique_ptr<ColourCorrector> corrector_;
    std::unique_ptr<DepthUploader> uploader_;
    TriangleBuilder triangles_;
    bool takes_all_;
    std::shared_ptr<const Instant> instant_ = std::make_shared<Instant>();
};

}  // namespace vantage

#pragma once

#include <span>

#include "host_app/background/background_access.h"
#include "host_app/surfaces/instant.h"
#include "host_app/surfaces/triangle_builder.h"
#include "host_app/views/depth_view.h"
#include "host_app/views/virtual_view.h"

namespace vantage {

/// How well an instant is prepared, and so at what cost. The governor moves along
/// prepare_levels().
struct PrepareLevel {
    int rank = 0;  ///< 0: the best; a higher one is cheaper
    std::size_t rigs = most_drawn_rigs;
    /// Performers' depth is held against the other rigs: what those see through is taken away, and
    /// depth is moved to where the rigs' pictures agree.
    bool is_refined = true;
    bool has_fine_grid = true;  ///< surfaces may be drawn by every pixel, with their rims
    float bend = TriangleBuilder::default_bend;  ///< that their coarse grids leave out
};

/// From the best to the cheapest, by rank.
std::span<const PrepareLevel> prepare_levels();

/// Makes instants of the rigs' depth views, on the GPU. Belongs to one thread and to the context
/// that was current at construction. What is learnt along time is kept here, in seconds.
class InstantPreparer {
  public:
    virtual ~InstantPreparer() = default;

    /// Takes the views of the next instant, filmed `dt_s` after the one before: uploads them and
    /// learns from them. Views may differ in size, lack depth, or be one or none.
    virtual void take(std::span<const DepthView> views, double dt_s) = 0;

    /// The instant that was taken last, ready to be rendered from `target` and near it. May be
    /// called again for another target or a better level.
    virtual std::shared_ptr<const Instant> prepare(const VirtualView& target,
                                                   const PrepareLevel& level) = 0;

    /// Does a piece of work that betters later instants, and waits for what of it has a thread of
    /// its own. `target`: what they are wished for.
    virtual void improve(const VirtualView& target) {
        while (improve_a_step(target)) continue;
    }
    /// A step of that, as long as a pass takes, where there is no time for more. True: more of the
    /// same work is left.
    virtual bool improve_a_step(const VirtualView& /*target*/) { return false; }

    /// Goes through all that these views may ever need, and learns nothing of them: a driver
    /// compiles a shader when it is first drawn with, which takes seconds for all of them.
    /// Precondition: nothing was taken yet, or it may be forgotten.
    virtual void warm_up(std::span<const DepthView> /*views*/, const VirtualView& /*target*/) {}

    /// The next instant does not follow the last one (a cut): nothing that moves goes on. What
    /// stands still is still known.
    virtual void cut() {}

    /// What it learns of the set; null: nothing.
    virtual BackgroundAccess* background_access() { return nullptr; }
};

}  // namespace vantage

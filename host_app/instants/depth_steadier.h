#pragma once

#include "common/gl/fullscreen_pass.h"
#include "host_app/instants/rig_history.h"

namespace vantage {

/// Keeps the depth of what stands still from boiling: the mean of the instants of the last `mean_s`
/// wherever neither the picture nor, beyond its uncertainty, the depth of a rig's pixel has
/// changed, and the depth before where that alone has, until it has changed for good: for
/// `patience_s` without a break, less where the picture has hardly come to rest. What moves is
/// taken as it comes.
class DepthSteadier {
  public:
    static constexpr double mean_s = 1.07, patience_s = 0.5;
    static constexpr int fewest = 8, most = 64;                   ///< instants of the mean
    static constexpr int least_patience = 2, most_patience = 30;  ///< instants

    explicit DepthSteadier(const ShaderLibrary& library)
        : pass_(library, "depth_steady.frag"), settle_(library, "surface_steady.frag") {}

    /// Fills the view's steady_depth(). Once an upload, after its colour was steadied.
    void steady(RigHistory& view);

    /// The same for what was drawn into the depth_target() of a surface of the same upload, which
    /// is settled then.
    void settle(const RigHistory& view, RigSurface& surface);

  private:
    FullscreenPass pass_, settle_;
};

}  // namespace vantage

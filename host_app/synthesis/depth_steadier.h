#pragma once

#include "common/gl/fullscreen_pass.h"
#include "host_app/synthesis/gpu_view.h"

namespace vantage {

/// Keeps the depth of what stands still from boiling: the mean of up to 32 instants wherever
/// neither the picture nor, beyond its uncertainty, the depth of a rig's pixel has changed, and the
/// depth before where that alone has, until it has changed for good: for fifteen instants in a row,
/// fewer where the picture has hardly come to rest. What moves is taken as it comes.
class DepthSteadier {
  public:
    explicit DepthSteadier(const ShaderLibrary& library)
        : pass_(library, "depth_steady.frag"), settle_(library, "surface_steady.frag") {}

    /// Fills the view's steady_depth(). Once an upload, after its colour was steadied.
    void steady(GpuView& view);

    /// The same for what was drawn into surface_target() of the same upload: fills surface().
    void settle(GpuView& view);

  private:
    FullscreenPass pass_, settle_;
};

}  // namespace vantage

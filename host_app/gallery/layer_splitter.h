#pragma once

#include <array>

#include "common/gl/fullscreen_pass.h"
#include "host_app/surfaces/rig_surface.h"

namespace vantage {

/// Splits a rig's view at depth edges into a main layer and a matted boundary layer, after Zitnick
/// et al., "High-quality video view interpolation using a layered representation" (2004).
class LayerSplitter {
  public:
    explicit LayerSplitter(const ShaderLibrary& library);

    /// Fills depth() and colour() of two surfaces of the same camera from those of `source`: of
    /// `main`, all that is not in front of a depth edge nearby, its colours freed from what is; of
    /// `boundary`, a strip of the nearer surface along depth edges (no depth elsewhere), alpha its
    /// matte.
    void split(const RigSurface& source, RigSurface& main, RigSurface& boundary);

  private:
    struct Passes {
        FullscreenPass depth, colour;
    };
    std::array<Passes, 2> passes_;  ///< of the main layer and of the boundary layer
};

}  // namespace vantage

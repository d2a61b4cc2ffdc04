#pragma once

#include "common/gl/fullscreen_pass.h"
#include "host_app/surfaces/rig_surface.h"

namespace vantage {

/// Lens and sensor mix the colours of both sides of a depth edge. Carried to another viewpoint,
/// such mixed pixels are the halos around the foreground and its ghosts on the background. This
/// notes how far each pixel's colour can be trusted, so that a rig that sees the place clear of
/// edges prevails over one that does not.
class EdgeConfidence {
  public:
    explicit EdgeConfidence(const ShaderLibrary& library)
        : pass_(library, "edge_confidence.frag") {}

    /// Fills the surface's trust(), from its depth.
    void judge(RigSurface& surface);

  private:
    FullscreenPass pass_;
};

}  // namespace vantage

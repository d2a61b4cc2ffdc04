#pragma once

#include "common/gl/fullscreen_pass.h"
#include "host_app/surfaces/rig_surface.h"

namespace vantage {

/// Edge confidence: how reliable the colour of each pixel is, from its distance to a depth edge.
/// Lens and sensor mix the colours of both sides of an edge; seen from another viewpoint, mixed
/// pixels are halos around the foreground and ghosts on the background. With the confidence, a rig
/// that sees a place clear of edges prevails over one that does not.
class EdgeConfidence {
  public:
    explicit EdgeConfidence(const ShaderLibrary& library)
        : pass_(library, "edge_confidence.frag") {}

    /// Fills the surface's confidence() from its depth.
    void judge(RigSurface& surface) {
        surface.confidence().resize(surface.colour().size());
        Program& program = pass_.use();
        program.input("depth_map", surface.depth());
        program.set("picture_size",
                    Eigen::Vector2i(surface.colour().width_px(), surface.colour().height_px()));
        pass_.draw(surface.confidence().target());
    }

  private:
    FullscreenPass pass_;
};

}  // namespace vantage

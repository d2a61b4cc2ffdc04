#pragma once

#include <span>
#include <string>

#include "common/gl/objects/program.h"
#include "common/gl/objects/vertex_array.h"
#include "host_app/baked/background_probe.h"
#include "host_app/surfaces/drawn_texture.h"

namespace vantage {

/// Draws a baked background from any place: the tiles of the nearest probe, and those of the next
/// one where the nearest has seen nothing.
/// Belongs to one context.
class BakedPainter {
  public:
    /// Probes that one picture is drawn from.
    static constexpr std::size_t most_probes = 2;

    explicit BakedPainter(const ShaderLibrary& library);

    /// Draws `view`. Alpha is that of the probes' pictures, and depth is negative where the place
    /// was never seen. The shares are how well each of `rigs`, at most four, sees the surface. The
    /// result is valid until the next call.
    const DepthPicture& draw(const BakedBackground& background, const VirtualView& view,
                             std::span<const std::string> rigs);

  private:
    void draw(const BackgroundProbe& probe, const BackgroundProbe::Part& part,
              const VirtualView& view, std::span<const std::string> rigs);

    Program program_;
    DrawnDepth depth_test_;
    DepthPicture picture_;
    VertexArray vertices_;
};

}  // namespace vantage

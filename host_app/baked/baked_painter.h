#pragma once

#include <span>

#include "common/gl/objects/program.h"
#include "common/gl/objects/vertex_array.h"
#include "host_app/baked/background_probe.h"
#include "host_app/surfaces/drawn_texture.h"

namespace vantage {

/// Draws a baked background from any place: the tiles of the nearest probes, with a depth test.
/// Belongs to one context.
class BakedPainter {
  public:
    /// Probes that one picture is drawn from.
    static constexpr std::size_t most_probes = 2;

    explicit BakedPainter(const ShaderLibrary& library);

    /// Draws `view`. Afterwards depth_m() and colour() have it.
    void draw(const BakedBackground& background, const VirtualView& view);

    /// r32f, metres, 0 = nothing, negative where the place was never seen.
    const Texture& depth_m() const { return *depth_m_; }
    /// rgba8, alpha as in the probes' pictures.
    const Texture& colour() const { return *colour_; }

  private:
    void resize(cv::Size size);
    /// Draws a part of a probe with its inverse depths multiplied by `nearer`.
    void draw(const BackgroundProbe& probe, const BackgroundProbe::Part& part,
              const VirtualView& view, float nearer);

    Program program_;
    std::optional<Texture> colour_, depth_m_, depth_test_;
    std::optional<Framebuffer> target_;
    VertexArray vertices_;
};

}  // namespace vantage

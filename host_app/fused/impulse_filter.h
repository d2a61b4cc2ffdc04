#pragma once

#include "common/gl/two_stage_pass.h"
#include "host_app/surfaces/drawn_texture.h"

namespace vantage {

/// Takes specks out of a picture: where depth errs by a pixel, a single pixel of another surface's
/// colour stands among those of its own. One at a depth edge that is brighter or darker in a
/// channel than all but one of its eight neighbours, by more than the tolerance, becomes the median
/// of the nine (a conditional median filter: Sun and Neuvo, 1994). Lines that are one pixel wide
/// stay, and so does what is within one surface.
class ImpulseFilter {
  public:
    /// Of 0..255: the noise of a camera stays below it.
    static constexpr int tolerance = 20;

    explicit ImpulseFilter(const ShaderLibrary& library) : pass_(library, "impulse_filter.frag") {}

    /// `depth_m` is r32f, 0 where nothing is, a negative depth as good as a positive one. The
    /// result is rgba8 as the picture, alpha as it was; valid until the next call.
    const Texture& filter(const Texture& picture, const Texture& depth_m);

  private:
    TwoStagePass pass_;
    DrawnTexture filtered_{TextureFormat::rgba8, Filter::linear, false, DrawnWith::depth_test};
};

}  // namespace vantage

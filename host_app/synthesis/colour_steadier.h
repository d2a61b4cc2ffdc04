#pragma once

#include "common/gl/fullscreen_pass.h"
#include "host_app/synthesis/gpu_view.h"

namespace vantage {

/// Takes the sensor's noise out of what stands still: the mean of up to eight instants and the new
/// one wherever a rig's picture has not changed. What moves is taken as it comes.
class ColourSteadier {
  public:
    explicit ColourSteadier(const ShaderLibrary& library) : pass_(library, "colour_steady.frag") {}

    /// Makes the view's colour() of its fresh_colour(). Once an upload, before anything reads
    /// colour().
    void steady(GpuView& view);

  private:
    FullscreenPass pass_;
};

}  // namespace vantage

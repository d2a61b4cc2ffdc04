#pragma once

#include "common/gl/fullscreen_pass.h"
#include "host_app/instants/rig_history.h"

namespace vantage {

/// Takes the sensor's noise out of what stands still: the mean of the pictures of the last
/// `mean_s`, of no fewer than `fewest` and no more than `most`, wherever a rig's picture has not
/// changed. What moves is taken as it comes.
class ColourSteadier {
  public:
    static constexpr double mean_s = 0.27;
    static constexpr int fewest = 4, most = 16;  ///< pictures

    explicit ColourSteadier(const ShaderLibrary& library) : pass_(library, "colour_steady.frag") {}

    /// Makes the view's colour() of its fresh_colour(). Once an upload, before anything reads
    /// colour().
    void steady(RigHistory& view);

  private:
    FullscreenPass pass_;
};

/// How many instants `dt_s` apart a filter of `seconds` spans, within bounds.
float instants_of(double seconds, double dt_s, int fewest, int most);

}  // namespace vantage

#pragma once

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "rig_firmware/stereo/disparity/streak_reference.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// Makes the streaks unknown that paths along the rows leave, where a pattern that repeats along
/// the row looks a little more like another of its periods: at most most_streak_rows of a column
/// that differ by more than a pixel from one surface right above and below them, while that surface
/// matches here as well, in a valley of the costs of its own (least_streak_valley), and hardly
/// worse (most_streak_gain). It is what a path down the column would object, for a small part of
/// its price; what is thin and truly before a wall looks nothing like the wall, and stays.
class StreakPass {
  public:
    StreakPass(const ShaderLibrary& library, const StereoLayout& layout, int disparities);

    /// disparity: in LeftRightPass's form, changed in place. costs: as PermPass leaves them.
    void run(PassProfiler& profiler, const Buffer& disparity, const Buffer& costs);

  private:
    StereoLayout layout_;
    Program program_;
};

}  // namespace vantage

#pragma once

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

// The definition of a streak, chosen on four photographs and eleven generated scenes. There the
// error changes by less than 1 % for 8 to 24 rows, a gain of 8 to 16 and a valley of 4 to 12. Gain
// and valley are in PermPass's costs, 0..max_perm_code.
inline constexpr int max_streak_rows = 16;
inline constexpr int max_streak_gain = 12;   ///< over the cost of the surface above and below
inline constexpr int min_streak_valley = 8;  ///< depth of the valley around that surface's cost

/// Makes the streaks unknown that paths along the rows leave, where a pattern that repeats along
/// the row looks a little more like another of its periods: at most max_streak_rows of a column
/// that differ by more than a pixel from one surface right above and below them, while that surface
/// matches here as well, in a valley of the costs of its own (min_streak_valley), and hardly
/// worse (max_streak_gain). It is what a path down the column would object, for a small part of
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

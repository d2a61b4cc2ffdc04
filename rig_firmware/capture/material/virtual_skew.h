#pragma once

#include <chrono>
#include <optional>

#include "common/config/rig_config.h"
#include "common/image/image.h"
#include "common/virtual_stage/filmed_bar.h"

namespace vantage {

/// How late the two sensors of a rig without cameras expose, and the bar before them that shows it.
class VirtualSkew {
  public:
    /// By [virtual_rig] and exposure_us of [source]. Throws Error for a bar that cannot be.
    VirtualSkew(const RigConfig& config, cv::Size picture);

    std::chrono::nanoseconds left() const { return left_; }
    std::chrono::nanoseconds right() const { return right_; }

    /// Draws the bar, if there is one, as both sensors see it that are exposed for this pulse. The
    /// pictures' memory is left as it is where others share it.
    void draw_bar(ColourImage& left, ColourImage& right, TaiTime pulse) const;

  private:
    std::chrono::nanoseconds left_, right_;
    std::optional<FilmedBar> bar_;
};

}  // namespace vantage

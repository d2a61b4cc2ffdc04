#pragma once

#include <chrono>
#include <optional>

#include "common/config/rig_config.h"
#include "common/image/image.h"
#include "common/virtual_stage/filmed_bar.h"

namespace vantage {

/// Simulated delay of the two sensors of a rig without cameras, and the sync bar in front of them
/// that shows it.
class VirtualSkew {
  public:
    /// Uses [virtual_rig] and exposure_us of [source]. Throws Error for a bar that is not possible.
    VirtualSkew(const RigConfig& config, cv::Size picture);

    std::chrono::nanoseconds left() const { return left_; }
    std::chrono::nanoseconds right() const { return right_; }

    /// Draws the bar, if there is one, as both sensors see it when they are exposed for this pulse.
    /// Images that share their memory are copied first.
    void draw_bar(ColourImage& left, ColourImage& right, TaiTime pulse) const;

  private:
    std::chrono::nanoseconds left_, right_;
    std::optional<FilmedBar> bar_;
};

}  // namespace vantage

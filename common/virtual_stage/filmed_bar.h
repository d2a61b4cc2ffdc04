#pragma once

#include <chrono>

#include <opencv2/core.hpp>

#include "common/base/time/time.h"
#include "common/image/image.h"
#include "common/sync/sync_bar.h"

namespace vantage {

/// Where a picture shows the bar: its first (fastest) and its last LED.
struct BarPlace {
    cv::Point2d first_px, last_px;
    double led_radius_px = 3;
    double led_light = 0.6;  ///< of a lit LED, linear; 1 is the most that a picture can show

    /// Across the upper part of a picture, not quite level.
    static BarPlace across(cv::Size picture, int leds);
};

/// A bar of LEDs on a dark board before everything else, as a sensor sees it that exposes for a
/// while: every LED as bright as the share of the exposure in which it was lit.
class FilmedBar {
  public:
    /// Throws Error for an exposure that is not positive.
    FilmedBar(const SyncBar& bar, const BarPlace& place, std::chrono::nanoseconds exposure);

    /// Draws it, sRGB-coded, as it was from `begin` on.
    void draw(ColourImage& picture, TaiTime begin) const;

  private:
    SyncBar bar_;
    BarPlace place_;
    std::chrono::nanoseconds exposure_;
};

}  // namespace vantage

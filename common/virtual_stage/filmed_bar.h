#pragma once

#include <chrono>

#include <opencv2/core.hpp>

#include "common/base/time/time.h"
#include "common/image/image.h"
#include "common/sync/sync_bar.h"

namespace vantage {

/// The position of the LED bar in an image: its first (fastest) and its last LED.
struct BarPlace {
    cv::Point2d first_px, last_px;
    double led_radius_px = 3;
    double led_light = 0.6;  ///< of a lit LED, linear; 1 is white

    /// Across the upper part of the image, slightly tilted.
    static BarPlace across(cv::Size picture, int leds);
};

/// Draws an LED bar on a dark board in front of everything else, as a sensor sees it during an
/// exposure: each LED is as bright as the share of the exposure in which it is lit.
class FilmedBar {
  public:
    /// Throws Error for an exposure that is not positive.
    FilmedBar(const SyncBar& bar, const BarPlace& place, std::chrono::nanoseconds exposure);

    /// Draws the bar, sRGB-coded, as seen during the exposure that begins at `begin`.
    void draw(ColourImage& picture, TaiTime begin) const;

  private:
    SyncBar bar_;
    BarPlace place_;
    std::chrono::nanoseconds exposure_;
};

}  // namespace vantage

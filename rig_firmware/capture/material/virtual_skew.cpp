#include "rig_firmware/capture/material/virtual_skew.h"

#include "common/base/time/time.h"

namespace vantage {

VirtualSkew::VirtualSkew(const RigConfig& config, cv::Size picture)
    : left_(from_us(config.virtual_rig.left_skew_us)),
      right_(from_us(config.virtual_rig.right_skew_us)) {
    const int leds = config.virtual_rig.bar_leds;
    if (leds > 0)
        bar_.emplace(SyncBar(leds, from_us(config.virtual_rig.bar_step_us)),
                     BarPlace::across(picture, leds), from_us(config.source.exposure_us));
}

void VirtualSkew::draw_bar(ColourImage& left, ColourImage& right, TaiTime pulse) const {
    if (!bar_) return;
    left = left.clone();
    right = right.clone();
    bar_->draw(left, pulse + left_);
    bar_->draw(right, pulse + right_);
}

}  // namespace vantage

#include "host_app/views/depth_view.h"

namespace vantage {

DisparityScale::DisparityScale(const RectifiedStereo& geometry, int columns)
    : px_per_step_(static_cast<float>(static_cast<double>(geometry.width_px) /
                                      (static_cast<double>(columns) * disparity_steps_per_px))),
      doffs_px_(static_cast<float>(geometry.doffs_px())),
      f_baseline_(static_cast<float>(geometry.f_px * geometry.baseline_m)) {}

float DisparityScale::depth_m(std::uint16_t steps) const {
    const float d = static_cast<float>(steps) * px_per_step_ + doffs_px_;
    return steps != 0 && d > 0 ? f_baseline_ / d : 0.0f;
}

}  // namespace vantage

#pragma once

#include "common/image/image.h"
#include "rig_firmware/stereo/thesis/settings.h"

namespace vantage::thesis {

/// The whole of the matcher `gradient` on the CPU, from the references of its passes.
DisparityImage gradient_reference(const ColourImage& left, const ColourImage& right,
                                  int disparities, const Settings& settings, bool fill);

}  // namespace vantage::thesis

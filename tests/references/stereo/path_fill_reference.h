#pragma once

#include "common/image/image.h"
#include "rig_firmware/stereo/disparity/path_fill_pass.h"
#include "tests/references/stereo/feature_reference.h"

namespace vantage {

/// CPU reference of PathFillPass, bit for bit.
DisparityImage filled_along_paths(const DisparityImage& disparity, const StereoPlanes& left,
                                  FillCell cell);

}  // namespace vantage

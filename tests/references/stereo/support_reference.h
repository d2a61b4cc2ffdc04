#pragma once

#include "common/image/image.h"

namespace vantage {

/// CPU reference of SupportPass: a disparity stays where at least SupportPass::min_support of the
/// 5x5 pixels two apart around it (edges repeated) are known and within one pixel of it; else it is
/// unknown.
DisparityImage supported_disparity(const DisparityImage& disparity);

}  // namespace vantage

#pragma once

#include "common/image/image.h"
#include "common/wire/frame_message.h"

namespace vantage {

/// Colours a rig's disparity for display: blue is far, red is the nearest searched disparity, black
/// is unknown. The range is the same for all frames.
ColourImage disparity_picture(const RigFrame& frame);

}  // namespace vantage

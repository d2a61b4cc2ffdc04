#pragma once

#include "common/image/image.h"
#include "common/wire/frame_message.h"

namespace vantage {

/// A rig's disparity for people: blue is far, red the nearest that the rig searched for, black
/// unknown. The range stays the same from frame to frame.
ColourImage disparity_picture(const RigFrame& frame);

}  // namespace vantage

#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/receive/frame_set.h"
#include "common/wire/frame_message.h"
#include "host_app/views/depth_view.h"

namespace vantage {

/// Converts a rig's frame to a view, which shares its pixels.
DepthView depth_view_of(const RigFrame& frame);
/// Converts the frames of a frame set that have pictures, with the colour corrections of their
/// rigs.
std::vector<DepthView> depth_views_of(const FrameSet& set,
                                      const std::map<std::string, ColourCorrection>& colours);

}  // namespace vantage

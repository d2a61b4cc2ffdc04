#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/receive/frame_set.h"
#include "common/wire/frame_message.h"
#include "host_app/views/depth_view.h"

namespace vantage {

/// A rig's frame as the synthesisers take it. Its pictures are shared, not copied.
DepthView depth_view_of(const RigFrame& frame);
/// Of all frames of the set that have pictures, with the colour corrections of those rigs that have
/// one.
std::vector<DepthView> depth_views_of(const FrameSet& set,
                                      const std::map<std::string, ColourCorrection>& colours);

}  // namespace vantage

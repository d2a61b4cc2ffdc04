#pragma once

#include "common/wire/frame_message.h"
#include "host_app/instants/depth_view.h"

namespace vantage {

/// A rig's frame as the synthesisers take it. Its pictures are shared, not copied.
DepthView depth_view_of(const RigFrame& frame);

}  // namespace vantage

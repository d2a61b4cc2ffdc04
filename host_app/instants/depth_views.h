#pragma once

#include "common/wire/frame_message.h"
#include "host_app/instants/depth_view.h"

namespace vantage {

/// Wire disparities (px of their own width) to depth, metres, of the same size: z = f * baseline /
/// (d + doffs), with d brought to px of the geometry's width. 0 where unknown, or where d + doffs
/// <= 0.
DepthImage depth_from_disparity(const DisparityImage& disparity, const RectifiedStereo& geometry);

/// A rig's frame as the synthesisers take it. The colour picture is shared, not copied.
DepthView depth_view_of(const RigFrame& frame);

}  // namespace vantage

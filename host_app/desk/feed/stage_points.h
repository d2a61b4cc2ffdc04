#pragma once

#include <vector>

#include "common/receive/frame_set.h"
#include "host_app/desk/desk_state.h"

namespace vantage {

/// A few thousand points of what the set's rigs see, in its colours, for a look at the stage from
/// outside.
std::vector<DeskPlan::Point> stage_points(const FrameSet& set);

}  // namespace vantage

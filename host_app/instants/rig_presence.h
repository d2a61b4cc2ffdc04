#pragma once

#include <memory>
#include <span>
#include <vector>

#include "host_app/instants/rig_history.h"

namespace vantage {

/// How long a rig takes to fade in or out.
inline constexpr double fade_s = 1.0 / 6;

/// Uploads the views of an instant that have depth, each to the one of its name in `rigs` where
/// there is one, and lets rigs fade instead of popping: one that is missing is shown as it was last
/// seen, less and less, and finally dropped; one that comes takes part more and more. Views of
/// other rigs altogether replace all. The instant is `dt_s` after the one before. Returns those
/// that were uploaded.
std::vector<RigHistory*> upload_with_fades(std::span<const DepthView> views, double dt_s,
                                           std::vector<std::unique_ptr<RigHistory>>& rigs);

}  // namespace vantage

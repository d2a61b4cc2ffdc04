#pragma once

#include <memory>
#include <span>
#include <vector>

#include "host_app/synthesis/gpu_view.h"

namespace vantage {

/// Instants over which a rig fades.
inline constexpr int fade_instants = 5;

/// Uploads the views of an instant that have depth, each to the one of its name in `on_gpu` where
/// there is one, and lets rigs fade instead of popping: one that is missing is shown as it was last
/// seen, less and less, and finally dropped; one that comes takes part more and more. Views of
/// other rigs altogether replace all. Returns those that were uploaded.
std::vector<GpuView*> upload_with_fades(std::span<const DepthView> views,
                                        std::vector<std::unique_ptr<GpuView>>& on_gpu);

}  // namespace vantage

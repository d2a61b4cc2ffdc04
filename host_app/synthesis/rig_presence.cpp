#include "host_app/synthesis/rig_presence.h"

#include <algorithm>

namespace vantage {
namespace {

constexpr float step = 1.0f / fade_instants;

}  // namespace

std::vector<GpuView*> upload_with_fades(std::span<const DepthView> views,
                                        std::vector<std::unique_ptr<GpuView>>& on_gpu) {
    std::vector<std::unique_ptr<GpuView>> before = std::move(on_gpu);
    on_gpu.clear();
    const auto known = [&](const DepthView& view) {
        return std::find_if(before.begin(), before.end(), [&](const auto& other) {
            return other && other->camera().name == view.name;
        });
    };
    const bool is_same_stage =
        views.empty() || std::any_of(views.begin(), views.end(), [&](const DepthView& view) {
            return known(view) != before.end();
        });
    if (!is_same_stage) before.clear();
    const bool is_first = before.empty();
    std::vector<GpuView*> uploaded;
    for (const DepthView& view : views) {
        if (view.depth_m.empty() || view.colour.empty()) continue;
        const auto found = known(view);
        if (found != before.end()) {
            on_gpu.push_back(std::move(*found));
            on_gpu.back()->set_presence(std::min(1.0f, on_gpu.back()->presence() + step));
        } else {
            on_gpu.push_back(std::make_unique<GpuView>());
            on_gpu.back()->set_presence(is_first ? 1.0f : step);
        }
        on_gpu.back()->upload(view);
        uploaded.push_back(on_gpu.back().get());
    }
    for (auto& missing : before) {
        if (!missing) continue;
        missing->set_presence(missing->presence() - step);
        if (missing->presence() > 0.5f * step) on_gpu.push_back(std::move(missing));
    }
    return uploaded;
}

}  // namespace vantage

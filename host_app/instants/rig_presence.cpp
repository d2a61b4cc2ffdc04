#include "host_app/instants/rig_presence.h"

#include <algorithm>

namespace vantage {

std::vector<RigHistory*> upload_with_fades(std::span<const DepthView> views, double dt_s,
                                           std::vector<std::unique_ptr<RigHistory>>& rigs) {
    const float step = static_cast<float>(std::min(dt_s / fade_s, 1.0));
    std::vector<std::unique_ptr<RigHistory>> before = std::move(rigs);
    rigs.clear();
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
    std::vector<RigHistory*> uploaded;
    for (const DepthView& view : views) {
        if (!view.has_depth() || view.colour.empty()) continue;
        const auto found = known(view);
        if (found != before.end()) {
            rigs.push_back(std::move(*found));
            rigs.back()->set_presence(std::min(1.0f, rigs.back()->presence() + step));
        } else {
            rigs.push_back(std::make_unique<RigHistory>());
            rigs.back()->set_presence(is_first ? 1.0f : step);
        }
        rigs.back()->upload(view, dt_s);
        uploaded.push_back(rigs.back().get());
    }
    for (auto& missing : before) {
        if (!missing) continue;
        missing->set_presence(missing->presence() - step);
        if (missing->presence() > 0.5f * step && missing->surface())
            rigs.push_back(std::move(missing));
    }
    return uploaded;
}

}  // namespace vantage

#include "host_app/surfaces/rig_roster.h"

#include <algorithm>

namespace vantage {

std::vector<RigHistory*> RigRoster::upload(std::span<const DepthView> views, double dt_s) {
    const float step = static_cast<float>(std::min(dt_s / fade_s, 1.0));
    const auto known = [this](const DepthView& view) {
        return std::find_if(rigs_.begin(), rigs_.end(),
                            [&](const auto& rig) { return rig->camera().name == view.name; });
    };
    const bool is_same_stage =
        views.empty() || std::any_of(views.begin(), views.end(), [&](const DepthView& view) {
            return known(view) != rigs_.end();
        });
    if (!is_same_stage) rigs_.clear();
    const bool is_first = rigs_.empty();
    std::vector<RigHistory*> uploaded;
    for (const DepthView& view : views) {
        if (!view.has_depth() || view.colour.empty()) continue;
        if (const auto found = known(view); found != rigs_.end()) {
            uploaded.push_back(found->get());
            uploaded.back()->set_presence(std::min(1.0f, uploaded.back()->presence() + step));
        } else {
            uploaded.push_back(rigs_.emplace_back(std::make_unique<RigHistory>()).get());
            uploaded.back()->set_presence(is_first ? 1.0f : step);
        }
        uploaded.back()->upload(view, dt_s);
    }
    shown_ = uploaded;
    for (const auto& rig : rigs_) {
        if (std::find(uploaded.begin(), uploaded.end(), rig.get()) != uploaded.end()) continue;
        rig->set_presence(rig->presence() - step);
        if (rig->presence() > 0.5f * step && rig->surface()) {
            shown_.push_back(rig.get());
        } else {
            rig->set_presence(0);
            rig->hide();
        }
    }
    return uploaded;
}

void RigRoster::cut() {
    for (const auto& rig : rigs_) rig->hide();
}

void RigRoster::forget() {
    for (const auto& rig : rigs_) rig->forget();
}

std::vector<RigHistory*> RigRoster::known() const {
    std::vector<RigHistory*> all;
    for (const auto& rig : rigs_) all.push_back(rig.get());
    return all;
}

bool RigRoster::has_learnt(const RigHistory* rig) const {
    return std::any_of(rigs_.begin(), rigs_.end(), [&](const auto& one) {
        return one.get() == rig && one->learnt_instants() > 0;
    });
}

}  // namespace vantage

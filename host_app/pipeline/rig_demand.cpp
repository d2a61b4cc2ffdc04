#include "host_app/pipeline/rig_demand.h"

#include <algorithm>

#include "host_app/views/view_ranking.h"

namespace vantage {

void RigDemand::see(std::span<const DepthView> views) {
    for (const DepthView& view : views) {
        Rig& rig = rigs_[view.name];
        rig.samples = surface_samples(view);
        rig.centre_m = view.world_from_camera.translation();
    }
}

void RigDemand::forget_others(const FrameSet& set) {
    std::erase_if(rigs_, [&](const auto& rig) {
        return std::none_of(set.slots.begin(), set.slots.end(),
                            [&](const FrameSet::Slot& slot) { return slot.rig == rig.first; });
    });
}

std::vector<RigDemand::Change> RigDemand::update(std::span<const VirtualView> targets,
                                                 MonotonicTime now) {
    for (auto& [name, rig] : rigs_)
        if (rig.last_needed == MonotonicTime{}) rig.last_needed = now;
    for (const VirtualView& target : targets) {
        std::vector<std::pair<double, Rig*>> ranked;
        for (auto& [name, rig] : rigs_)
            ranked.emplace_back(usefulness(rig.samples.points_m, rig.centre_m, target), &rig);
        std::stable_sort(ranked.begin(), ranked.end(),
                         [](const auto& a, const auto& b) { return a.first > b.first; });
        for (std::size_t i = 0; i < std::min(most_rigs, ranked.size()); ++i)
            ranked[i].second->last_needed = now;
    }
    std::vector<Change> changes;
    for (auto& [name, rig] : rigs_) {
        const bool streaming = now - rig.last_needed < hold;
        if (streaming != rig.streaming) changes.push_back({name, streaming});
        rig.streaming = streaming;
    }
    return changes;
}

}  // namespace vantage

#include "host_app/session/stage_corridor.h"

#include <algorithm>
#include <vector>

namespace vantage {
namespace {

/// Time without frames after which a rig is away: shorter gaps would make the corridor flicker.
constexpr std::chrono::seconds away_after{2};

CorridorRig rig_of(const RigFrame& frame) {
    const RectifiedStereo& geometry = frame.geometry;
    return {frame.world_from_camera, 0.5 * geometry.width_px / geometry.f_px,
            0.5 * geometry.height_px / geometry.f_px};
}

bool is_same(const CorridorRig& a, const CorridorRig& b) {
    return a.half_width == b.half_width && a.half_height == b.half_height &&
           a.world_from_camera.matrix() == b.world_from_camera.matrix();
}

}  // namespace

void StageCorridor::update(const FrameSet& set) {
    if (!extent_ || set.complete == updated_) return;
    updated_ = set.complete;
    // Rigs without a slot are removed from the stage.
    bool changed =
        std::erase_if(rigs_, [&](const auto& rig) {
            return std::none_of(set.slots.begin(), set.slots.end(),
                                [&](const FrameSet::Slot& slot) { return slot.rig == rig.first; });
        }) > 0;
    for (const FrameSet::Slot& slot : set.slots) {
        const auto known = rigs_.find(slot.rig);
        if (slot.frame) {
            const CorridorRig rig = rig_of(*slot.frame);
            changed |=
                known == rigs_.end() || known->second.is_away || !is_same(rig, known->second.rig);
            rigs_.insert_or_assign(slot.rig, Rig{rig, set.complete, false});
        } else if (known != rigs_.end()) {
            Rig& rig = known->second;
            if (slot.absence == Absence::not_asked) rig.seen = set.complete;
            const bool is_away = set.complete - rig.seen > away_after;
            changed |= is_away != rig.is_away;
            rig.is_away = is_away;
        }
    }
    if (!changed) return;
    std::vector<CorridorRig> there;
    StagePlaces places{{}, *extent_};
    for (const auto& [name, rig] : rigs_) {
        places.rigs.push_back({name, rig.rig, rig.is_away});
        if (!rig.is_away) there.push_back(rig.rig);
    }
    auto corridor = std::make_shared<const Corridor>(std::move(there), *extent_, aspect_);
    const std::lock_guard lock(mutex_);
    now_ = std::move(corridor);
    places_ = std::move(places);
}

std::optional<StagePlaces> StageCorridor::places() const {
    const std::lock_guard lock(mutex_);
    return places_;
}

std::shared_ptr<const Corridor> StageCorridor::now() const {
    const std::lock_guard lock(mutex_);
    return now_;
}

}  // namespace vantage

#include "host_app/foreground/motion/interpolated_frame_sets.h"

#include <algorithm>
#include <future>

#include "host_app/foreground/motion/rig_agreement.h"
#include "host_app/foreground/motion/rig_motion.h"

namespace vantage {

const FrameSet* InterpolatedFrameSets::fetch(const PastFrameSets& past, std::uint64_t pulse) {
    if (const auto found = sets_.find(pulse); found != sets_.end()) return &found->second;
    const auto wanted = static_cast<double>(pulse);
    if (past.pulse_at(wanted) != pulse) return nullptr;
    std::optional<FrameSet> set = past.at(wanted);
    if (!set || set->trigger_index != pulse) return nullptr;
    return &sets_.emplace(pulse, std::move(*set)).first->second;
}

std::optional<FrameSet> InterpolatedFrameSets::at(const PastFrameSets& past, std::uint64_t pulse,
                                                  double share) {
    std::erase_if(sets_,
                  [&](const auto& each) { return each.first != pulse && each.first != pulse + 1; });
    const FrameSet* first = fetch(past, pulse);
    if (!first) return std::nullopt;
    FrameSet set = *first;
    const FrameSet* second = fetch(past, pulse + 1);
    if (!second) return set;
    const std::size_t rigs = std::min(first->slots.size(), second->slots.size());
    const auto for_rigs_of_both = [&](const auto& work) {
        std::vector<std::future<void>> works;
        for (std::size_t rig = 0; rig < rigs; ++rig)
            if (first->slots[rig].frame && second->slots[rig].frame)
                works.push_back(std::async(std::launch::async, [&work, rig] { work(rig); }));
        for (std::future<void>& each : works) each.get();
    };
    if (motion_from_ != pulse || motions_.size() != rigs) {
        motion_from_.reset();
        motions_.assign(rigs, {});
        for_rigs_of_both([&](std::size_t rig) {
            motions_[rig] = motion_between(*first->slots[rig].frame, *second->slots[rig].frame);
        });
        std::vector<FollowedRig> followed;
        for (std::size_t rig = 0; rig < rigs; ++rig)
            followed.push_back(
                {first->slots[rig].frame.get(), second->slots[rig].frame.get(), &motions_[rig]});
        agree_on_motion(followed);
        motion_from_ = pulse;
    }
    for_rigs_of_both([&](std::size_t rig) {
        if (motions_[rig].empty()) return;
        set.slots[rig].frame = std::make_shared<const RigFrame>(frame_between(
            *first->slots[rig].frame, *second->slots[rig].frame, motions_[rig], share));
    });
    set.complete = MonotonicClock::now();
    return set;
}

}  // namespace vantage

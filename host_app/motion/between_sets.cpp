#include "host_app/motion/between_sets.h"

#include <algorithm>
#include <future>

namespace vantage {

const FrameSet* BetweenSets::fetch(const PastSets& past, std::uint64_t pulse) {
    if (const auto found = sets_.find(pulse); found != sets_.end()) return &found->second;
    const auto wanted = static_cast<double>(pulse);
    if (past.pulse_at(wanted) != pulse) return nullptr;
    std::optional<FrameSet> set = past.at(wanted);
    if (!set || set->trigger_index != pulse) return nullptr;
    return &sets_.emplace(pulse, std::move(*set)).first->second;
}

std::optional<FrameSet> BetweenSets::at(const PastSets& past, std::uint64_t pulse, double share) {
    std::erase_if(sets_,
                  [&](const auto& each) { return each.first != pulse && each.first != pulse + 1; });
    const FrameSet* first = fetch(past, pulse);
    if (!first) return std::nullopt;
    FrameSet set = *first;
    const FrameSet* second = fetch(past, pulse + 1);
    if (!second) return set;
    const std::size_t rigs = std::min(first->slots.size(), second->slots.size());
    const bool is_known = motion_from_ == pulse && motions_.size() == rigs;
    if (!is_known) motions_.assign(rigs, {});
    motion_from_ = pulse;
    std::vector<std::future<void>> works;
    for (std::size_t rig = 0; rig < rigs; ++rig) {
        const std::shared_ptr<const RigFrame> a = first->slots[rig].frame,
                                              b = second->slots[rig].frame;
        if (!a || !b) continue;
        works.push_back(std::async(std::launch::async, [&, a, b, rig] {
            if (!is_known) motions_[rig] = motion_between(*a, *b);
            if (motions_[rig].empty()) return;
            set.slots[rig].frame =
                std::make_shared<const RigFrame>(frame_between(*a, *b, motions_[rig], share));
        }));
    }
    for (std::future<void>& work : works) work.get();
    set.complete = MonotonicClock::now();
    return set;
}

}  // namespace vantage

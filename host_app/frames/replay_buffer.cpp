#include "host_app/frames/replay_buffer.h"

#include <algorithm>
#include <future>

namespace vantage {
namespace {

/// Cannot fail, since the frame was decoded once on arrival.
std::shared_ptr<const RigFrame> decode(const std::shared_ptr<const PackedFrame>& packed) {
    auto frame = std::make_shared<RigFrame>(
        FrameDecoder().decode(packed->header, packed->colour, packed->disparity));
    frame->packed = packed;
    return frame;
}

}  // namespace

ReplayBuffer::Kept ReplayBuffer::kept_of(const FrameSet& set) {
    Kept kept{set.trigger_index, set.complete, {}, 0};
    for (const FrameSet::Slot& slot : set.slots) {
        Slot& own = kept.slots.emplace_back(Slot{slot.rig, nullptr, nullptr, slot.absence});
        if (!slot.frame) continue;
        if (slot.frame->packed) {
            own.packed = slot.frame->packed;
            kept.bytes += own.packed->bytes();
        } else {
            own.frame = slot.frame;
            kept.bytes += own.frame->colour.total() * own.frame->colour.elemSize() +
                          own.frame->disparity.total() * own.frame->disparity.elemSize();
        }
    }
    return kept;
}

void ReplayBuffer::add(const FrameSet& set) {
    Kept kept = kept_of(set);
    const std::lock_guard lock(mutex_);
    if (!kept_.empty() && set.trigger_index <= kept_.back().trigger_index) {
        kept_.clear();
        bytes_ = 0;
    }
    bytes_ += kept.bytes;
    kept_.push_back(std::move(kept));
    while (bytes_ > max_bytes_) {
        bytes_ -= kept_.front().bytes;
        kept_.pop_front();
    }
}

const ReplayBuffer::Kept* ReplayBuffer::find(double pulse) const {
    if (kept_.empty()) return nullptr;
    const auto later =
        std::upper_bound(kept_.begin(), kept_.end(), pulse, [](double wanted, const Kept& each) {
            return wanted < static_cast<double>(each.trigger_index);
        });
    return later == kept_.begin() ? &kept_.front() : &*std::prev(later);
}

std::optional<std::uint64_t> ReplayBuffer::pulse_at(double pulse) const {
    const std::lock_guard lock(mutex_);
    const Kept* kept = find(pulse);
    return kept ? std::optional(kept->trigger_index) : std::nullopt;
}

std::optional<FrameSet> ReplayBuffer::at(double pulse) const {
    Kept kept;
    {
        const std::lock_guard lock(mutex_);
        const Kept* found = find(pulse);
        if (!found) return std::nullopt;
        kept = *found;
    }
    std::vector<std::future<std::shared_ptr<const RigFrame>>> decoding;
    for (const Slot& slot : kept.slots)
        decoding.push_back(slot.packed ? std::async(std::launch::async, decode, slot.packed)
                                       : std::future<std::shared_ptr<const RigFrame>>());
    FrameSet set;
    set.trigger_index = kept.trigger_index;
    set.complete = kept.complete;
    for (std::size_t i = 0; i < kept.slots.size(); ++i) {
        const Slot& slot = kept.slots[i];
        set.slots.push_back(
            {slot.rig, decoding[i].valid() ? decoding[i].get() : slot.frame, slot.absence});
    }
    return set;
}

std::optional<PastFrameSets::Span> ReplayBuffer::span() const {
    const std::lock_guard lock(mutex_);
    if (kept_.empty()) return std::nullopt;
    return Span{kept_.front().trigger_index, kept_.back().trigger_index, kept_.size(), bytes_};
}

StageFeed kept_feed(StageFeed feed, ReplayBuffer& ring) {
    StageFeed kept = feed;
    kept.next = [next = std::move(feed.next), &ring](std::chrono::nanoseconds timeout) {
        std::optional<FrameSet> set = next(timeout);
        if (set) ring.add(*set);
        return set;
    };
    return kept;
}

}  // namespace vantage

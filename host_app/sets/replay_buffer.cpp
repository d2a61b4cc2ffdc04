#include "host_app/sets/replay_buffer.h"

#include <algorithm>

namespace vantage {
namespace {

std::size_t bytes_of(const FrameSet& set) {
    std::size_t bytes = 0;
    for (const FrameSet::Slot& slot : set.slots)
        if (slot.frame)
            bytes += slot.frame->colour.total() * slot.frame->colour.elemSize() +
                     slot.frame->disparity.total() * slot.frame->disparity.elemSize();
    return bytes;
}

}  // namespace

void ReplayBuffer::add(const FrameSet& set) {
    const std::size_t bytes = bytes_of(set);
    const std::lock_guard lock(mutex_);
    if (!kept_.empty() && set.trigger_index <= kept_.back().set.trigger_index) {
        kept_.clear();
        bytes_ = 0;
    }
    kept_.push_back({set, bytes});
    bytes_ += bytes;
    while (bytes_ > max_bytes_) {
        bytes_ -= kept_.front().bytes;
        kept_.pop_front();
    }
}

std::optional<FrameSet> ReplayBuffer::at(double pulse) const {
    const std::lock_guard lock(mutex_);
    if (kept_.empty()) return std::nullopt;
    const auto later =
        std::upper_bound(kept_.begin(), kept_.end(), pulse, [](double wanted, const Kept& kept) {
            return wanted < static_cast<double>(kept.set.trigger_index);
        });
    return later == kept_.begin() ? kept_.front().set : std::prev(later)->set;
}

std::optional<ReplayBuffer::Span> ReplayBuffer::span() const {
    const std::lock_guard lock(mutex_);
    if (kept_.empty()) return std::nullopt;
    return Span{kept_.front().set.trigger_index, kept_.back().set.trigger_index, kept_.size(),
                bytes_};
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

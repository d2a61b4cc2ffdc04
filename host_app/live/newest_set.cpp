#include "host_app/live/newest_set.h"

namespace vantage {
namespace {

/// How long the thread may take to notice that it should end.
constexpr std::chrono::milliseconds patience{50};

}  // namespace

void count_frames(const FrameSet& set, RigCounts& counts) {
    for (const FrameSet::Slot& slot : set.slots)
        if (slot.frame) ++counts[slot.rig];
}

NewestSet::NewestSet(StageFeed feed) : feed_(std::move(feed)), thread_([this] { run(); }) {}

NewestSet::~NewestSet() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    thread_.join();
}

std::optional<FrameSet> NewestSet::take(std::chrono::nanoseconds timeout) {
    std::unique_lock lock(mutex_);
    arrived_.wait_for(lock, timeout, [&] { return newest_ || failure_; });
    if (failure_) std::rethrow_exception(failure_);
    std::optional<FrameSet> taken = std::move(newest_);
    newest_.reset();
    return taken;
}

NewestSet::Superseded NewestSet::superseded() const {
    const std::lock_guard lock(mutex_);
    return superseded_;
}

void NewestSet::run() {
    try {
        for (;;) {
            std::optional<FrameSet> set = feed_.next(patience);
            {
                const std::lock_guard lock(mutex_);
                if (stopping_) return;
                if (!set) continue;
                if (newest_) {
                    ++superseded_.sets;
                    count_frames(*newest_, superseded_.frames);
                }
                newest_.swap(set);
            }
            arrived_.notify_all();
        }
    } catch (...) {
        {
            const std::lock_guard lock(mutex_);
            failure_ = std::current_exception();
        }
        arrived_.notify_all();
    }
}

}  // namespace vantage

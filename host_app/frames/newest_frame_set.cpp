#include "host_app/frames/newest_frame_set.h"

#include "common/base/this_thread.h"

namespace vantage {
namespace {

/// How long the thread may take to notice that it should end.
constexpr std::chrono::milliseconds patience{50};

}  // namespace

void count_frames(const FrameSet& set, RigCounts& counts) {
    for (const FrameSet::Slot& slot : set.slots)
        if (slot.frame) ++counts[slot.rig];
}

NewestFrameSet::NewestFrameSet(StageFeed feed) : feed_(std::move(feed)), thread_([this] { run(); }) {}

NewestFrameSet::~NewestFrameSet() { stop(); }

void NewestFrameSet::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    if (thread_.joinable()) thread_.join();
}

void NewestFrameSet::supersede(const FrameSet& set) {
    ++superseded_.sets;
    count_frames(set, superseded_.frames);
}

ReceiverStatus NewestFrameSet::close() {
    stop();
    const std::lock_guard lock(mutex_);
    if (newest_) supersede(*newest_);
    newest_.reset();
    ReceiverStatus status = feed_.status();
    // Sets that were closed since the thread looked last; a set is counted a moment before it can
    // be taken.
    for (int tries = 0; tries < 1000 && !failure_; ++tries) {
        if (taken_off_ + status.frame_sets_dropped >= status.sets) break;
        while (const std::optional<FrameSet> set = feed_.next(std::chrono::milliseconds(1))) {
            ++taken_off_;
            supersede(*set);
        }
        status = feed_.status();
    }
    return status;
}

std::optional<FrameSet> NewestFrameSet::take(std::chrono::nanoseconds timeout) {
    std::unique_lock lock(mutex_);
    arrived_.wait_for(lock, timeout, [&] { return newest_ || failure_; });
    if (failure_) std::rethrow_exception(failure_);
    std::optional<FrameSet> taken = std::move(newest_);
    newest_.reset();
    return taken;
}

NewestFrameSet::Superseded NewestFrameSet::superseded() const {
    const std::lock_guard lock(mutex_);
    return superseded_;
}

void NewestFrameSet::run() {
    name_this_thread("sets");
    try {
        for (;;) {
            std::optional<FrameSet> set = feed_.next(patience);
            {
                const std::lock_guard lock(mutex_);
                if (set) {
                    ++taken_off_;
                    if (newest_) supersede(*newest_);
                    newest_.swap(set);
                }
                if (stopping_) return;
                if (!newest_) continue;
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

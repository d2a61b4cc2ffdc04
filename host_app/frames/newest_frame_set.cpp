#include "host_app/frames/newest_frame_set.h"

#include "common/base/this_thread.h"

namespace vantage {
namespace {

/// Longest wait for a frame set, and so for the thread to notice that it is to end.
constexpr std::chrono::milliseconds poll_period{50};

}  // namespace

void count_frames(const FrameSet& set, RigCounts& counts) {
    for (const FrameSet::Slot& slot : set.slots)
        if (slot.frame) ++counts[slot.rig];
}

NewestFrameSet::NewestFrameSet(StageFeed feed)
    : feed_(std::move(feed)), thread_([this] { run(); }) {}

NewestFrameSet::~NewestFrameSet() { stop(); }

void NewestFrameSet::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    if (thread_.joinable()) thread_.join();
}

void NewestFrameSet::count_replaced(const FrameSet& set) {
    ++replaced_.sets;
    count_frames(set, replaced_.frames);
}

ReceiverStatus NewestFrameSet::close() {
    stop();
    const std::lock_guard lock(mutex_);
    if (newest_) count_replaced(*newest_);
    newest_.reset();
    ReceiverStatus status = feed_.status();
    // Read frame sets that were closed after the thread ended. The receiver counts a frame set a
    // moment before it can be read.
    for (int tries = 0; tries < 1000 && !failure_; ++tries) {
        if (taken_off_ + status.frame_sets_dropped >= status.sets) break;
        while (const std::optional<FrameSet> set = feed_.next(std::chrono::milliseconds(1))) {
            ++taken_off_;
            count_replaced(*set);
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

NewestFrameSet::Replaced NewestFrameSet::replaced() const {
    const std::lock_guard lock(mutex_);
    return replaced_;
}

void NewestFrameSet::run() {
    name_this_thread("frame sets");
    try {
        for (;;) {
            std::optional<FrameSet> set = feed_.next(poll_period);
            {
                const std::lock_guard lock(mutex_);
                if (set) {
                    ++taken_off_;
                    if (newest_) count_replaced(*newest_);
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

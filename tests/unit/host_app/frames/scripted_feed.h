#pragma once

#include <algorithm>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "common/base/bounded_queue.h"
#include "common/base/error.h"
#include "common/geometry/pose.h"
#include "host_app/frames/stage_feed.h"

namespace vantage {

/// A substitute for the receiver: it returns the frame sets that a test pushes, and counts them.
class ScriptedFeed {
  public:
    explicit ScriptedFeed(std::vector<std::string> rigs) : rigs_(std::move(rigs)) {}

    /// A frame set of pulse k with frames of the rigs in `present`. They show a wall at 2 m, in
    /// `colour` in the middle and black at the left and right.
    FrameSet set(std::uint64_t k, const std::vector<std::string>& present,
                 cv::Vec4b colour = {200, 100, 50, 255}) const {
        FrameSet made;
        made.trigger_index = k;
        for (const std::string& rig : rigs_) {
            FrameSet::Slot slot{rig, nullptr, Absence::late};
            if (std::find(present.begin(), present.end(), rig) != present.end())
                slot = {rig, frame(rig, k, colour), Absence::none};
            made.slots.push_back(slot);
        }
        return made;
    }

    void push(const FrameSet& set) {
        {
            const std::lock_guard lock(mutex_);
            ++status_.sets;
            status_.complete_frame_sets += set.present() == static_cast<int>(set.slots.size());
            status_.newest_frame_set = MonotonicClock::now();
        }
        queue_.push(set);
    }
    void set_refused(const std::string& sentence) {
        const std::lock_guard lock(mutex_);
        refused_ = sentence;
    }
    /// Sets the start-up step that every rig reports; empty once the rigs send frames.
    void set_starting(const std::string& words) {
        const std::lock_guard lock(mutex_);
        starting_ = words;
    }
    /// Makes the feed throw from now on.
    void fail_with(std::string sentence) {
        const std::lock_guard lock(mutex_);
        failure_ = std::move(sentence);
    }
    bool drained() const { return queue_.size() == 0; }

    StageFeed feed() {
        return {[this](std::chrono::nanoseconds timeout) {
                    {
                        const std::lock_guard lock(mutex_);
                        if (!failure_.empty()) throw Error(failure_);
                    }
                    return queue_.pop_for(timeout);
                },
                [this] {
                    const std::lock_guard lock(mutex_);
                    ReceiverStatus status = status_;
                    for (const std::string& rig : rigs_) {
                        RigStatus entry;
                        entry.rig = rig;
                        entry.connected = refused_.empty();
                        entry.refused = refused_;
                        entry.health.starting = starting_;
                        status.rigs.push_back(entry);
                    }
                    return status;
                }};
    }

  private:
    static std::shared_ptr<const RigFrame> frame(const std::string& rig, std::uint64_t k,
                                                 cv::Vec4b colour) {
        auto made = std::make_shared<RigFrame>();
        made->rig = rig;
        made->trigger_index = k;
        made->synchronized = true;
        made->exposure = TaiClock::now();
        made->geometry.width_px = 62;
        made->geometry.height_px = 46;
        made->geometry.f_px = 40;
        made->geometry.cx_left_px = made->geometry.cx_right_px = 30.5;
        made->geometry.cy_px = 22.5;
        made->geometry.baseline_m = 0.1;
        made->world_from_camera = look_at({0, 1, 4.5}, {0, 1, 0});
        made->colour = ColourImage(46, 62, cv::Vec4b(0, 0, 0, 255));
        made->colour.colRange(12, 50).setTo(colour);
        made->disparity = DisparityImage(46, 62, static_cast<unsigned short>(2 * 32));
        made->max_disparity_px = 32;
        made->times = {1, 2, 3, 4};
        return made;
    }

    std::vector<std::string> rigs_;
    BoundedQueue<FrameSet> queue_{64};
    mutable std::mutex mutex_;
    ReceiverStatus status_;
    std::string refused_, starting_, failure_;
};

}  // namespace vantage

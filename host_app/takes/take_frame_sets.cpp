#include "host_app/takes/take_frame_sets.h"

#include <algorithm>
#include <thread>

#include "common/base/error.h"
#include "common/base/log.h"

namespace vantage {

TakeFrameSets::TakeFrameSets(std::shared_ptr<const TakeReader> take) : take_(std::move(take)) {
    for (std::size_t i = 0; i < take_->facts().rigs.size(); ++i) {
        rigs_.push_back(std::make_unique<Rig>());
        rigs_.back()->name = take_->facts().rigs[i].name;
        rigs_.back()->restorer = std::make_unique<FrameRestorer>(take_->facts().rigs[i]);
        for (const TakeReader::Frame& frame : take_->frames(i)) pulses_.push_back(frame.pulse);
    }
    std::sort(pulses_.begin(), pulses_.end());
    pulses_.erase(std::unique(pulses_.begin(), pulses_.end()), pulses_.end());
    if (pulses_.empty()) fail("{} has no frames", take_->path().string());
}

TakeFrameSets::~TakeFrameSets() {
    if (ahead_) ahead_->set.wait();
    if (given_up_.valid()) given_up_.wait();
}

std::size_t TakeFrameSets::place_of(double pulse) const {
    const auto later = std::upper_bound(
        pulses_.begin(), pulses_.end(), pulse,
        [](double wanted, std::uint64_t each) { return wanted < static_cast<double>(each); });
    return later == pulses_.begin() ? 0 : static_cast<std::size_t>(later - pulses_.begin()) - 1;
}

std::optional<std::uint64_t> TakeFrameSets::pulse_at(double pulse) const {
    return pulses_[place_of(pulse)];
}

std::optional<PastFrameSets::Span> TakeFrameSets::span() const {
    return Span{pulses_.front(), pulses_.back(), pulses_.size(), take_->bytes()};
}

std::optional<FrameSet> TakeFrameSets::take_ahead(std::uint64_t pulse) const {
    std::optional<Ahead> ahead;
    {
        const std::lock_guard lock(mutex_);
        ahead = std::exchange(ahead_, std::nullopt);
        if (ahead && ahead->pulse != pulse) {
            *ahead->unwanted = true;
            given_up_ = std::move(ahead->set);
            return std::nullopt;
        }
    }
    return ahead ? std::optional(ahead->set.get()) : std::nullopt;
}

void TakeFrameSets::decode_ahead(std::uint64_t pulse) const {
    const std::lock_guard lock(mutex_);
    if (ahead_) return;
    if (given_up_.valid() &&
        given_up_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return;
    const auto unwanted = std::make_shared<Unwanted>(false);
    ahead_ = Ahead{pulse, unwanted, std::async(std::launch::async, [this, pulse, unwanted] {
                       return decode(pulse, *unwanted);
                   })};
}

std::optional<FrameSet> TakeFrameSets::at(double pulse) const {
    const std::size_t place = place_of(pulse);
    const auto here = static_cast<std::ptrdiff_t>(place);
    std::ptrdiff_t stride = 0, stride_before = 0;
    {
        const std::lock_guard lock(mutex_);
        stride = here - std::exchange(last_place_, here);
        stride_before = std::exchange(last_stride_, stride);
    }
    std::optional<FrameSet> set = take_ahead(pulses_[place]);
    if (!set) set = decode(pulses_[place], Unwanted(false));
    set->complete = MonotonicClock::now();
    const std::ptrdiff_t next = here + stride;
    if (stride != 0 && stride == stride_before && next >= 0 && next < std::ssize(pulses_))
        decode_ahead(pulses_[static_cast<std::size_t>(next)]);
    return set;
}

FrameSet TakeFrameSets::decode(std::uint64_t pulse, const Unwanted& unwanted) const {
    std::vector<std::future<std::shared_ptr<const RigFrame>>> frames;
    for (std::size_t rig = 0; rig < rigs_.size(); ++rig)
        frames.push_back(std::async(std::launch::async, [this, rig, pulse, &unwanted] {
            return decode(rig, pulse, unwanted);
        }));
    FrameSet set;
    set.trigger_index = pulse;
    for (std::size_t rig = 0; rig < rigs_.size(); ++rig) {
        std::shared_ptr<const RigFrame> frame = frames[rig].get();
        const Absence absence = frame ? Absence::none : Absence::missed_by_rig;
        set.slots.push_back({rigs_[rig]->name, std::move(frame), absence});
    }
    return set;
}

std::shared_ptr<const RigFrame> TakeFrameSets::decode(std::size_t number, std::uint64_t pulse,
                                                      const Unwanted& unwanted) const {
    const std::vector<TakeReader::Frame>& frames = take_->frames(number);
    const auto frame = std::lower_bound(
        frames.begin(), frames.end(), pulse,
        [](const TakeReader::Frame& each, std::uint64_t wanted) { return each.pulse < wanted; });
    if (unwanted || frame == frames.end() || frame->pulse != pulse) return nullptr;
    Rig& rig = *rigs_[number];
    try {
        const StoredFrame stored = take_->load(number, *frame);
        const std::lock_guard lock(rig.mutex);
        if (unwanted) return nullptr;
        return std::make_shared<const RigFrame>(rig.restorer->restore(stored));
    } catch (const Error& error) {
        const std::lock_guard lock(rig.mutex);
        if (!std::exchange(rig.is_told, true))
            log_warning("{}; vantage take check lists all damage", error.what());
        return nullptr;
    }
}

StageFeed feed_of(const TakeReader& take) {
    ReceiverStatus status;
    for (const TakeRig& rig : take.facts().rigs) {
        RigStatus& entry = status.rigs.emplace_back();
        entry.rig = rig.name;
        entry.connected = true;
        entry.same_clock = true;
        entry.stage_rate_hz = take.facts().pulse_rate_hz;
    }
    return {[](std::chrono::nanoseconds timeout) -> std::optional<FrameSet> {
                std::this_thread::sleep_for(timeout);
                return std::nullopt;
            },
            [status] { return status; }};
}

}  // namespace vantage

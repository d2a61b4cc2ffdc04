#include "host_app/takes/take_sets.h"

#include <algorithm>
#include <thread>

#include "common/base/error.h"
#include "common/base/log.h"

namespace vantage {

TakeSets::TakeSets(std::shared_ptr<const TakeReader> take) : take_(std::move(take)) {
    for (std::size_t i = 0; i < take_->facts().rigs.size(); ++i) {
        rigs_.push_back(std::make_unique<Rig>());
        rigs_.back()->name = take_->facts().rigs[i].name;
        rigs_.back()->restorer = std::make_unique<FrameRestorer>(take_->facts().rigs[i]);
        for (const TakeReader::Frame& frame : take_->frames(i)) pulses_.push_back(frame.pulse);
    }
    std::sort(pulses_.begin(), pulses_.end());
    pulses_.erase(std::unique(pulses_.begin(), pulses_.end()), pulses_.end());
    if (pulses_.empty()) fail("{} holds no frame", take_->path().string());
}

TakeSets::~TakeSets() {
    if (ahead_) ahead_->set.wait();
}

std::size_t TakeSets::place_of(double pulse) const {
    const auto later = std::upper_bound(
        pulses_.begin(), pulses_.end(), pulse,
        [](double wanted, std::uint64_t each) { return wanted < static_cast<double>(each); });
    return later == pulses_.begin() ? 0 : static_cast<std::size_t>(later - pulses_.begin()) - 1;
}

std::optional<std::uint64_t> TakeSets::pulse_at(double pulse) const {
    return pulses_[place_of(pulse)];
}

std::optional<PastSets::Span> TakeSets::span() const {
    return Span{pulses_.front(), pulses_.back(), pulses_.size(), take_->bytes()};
}

std::optional<FrameSet> TakeSets::at(double pulse) const {
    const std::size_t place = place_of(pulse);
    std::optional<Ahead> ahead;
    bool goes_back = false;
    {
        const std::lock_guard lock(mutex_);
        ahead = std::exchange(ahead_, std::nullopt);
        goes_back = place < last_place_;
        last_place_ = place;
    }
    // Of another place it is thrown away, when it is done.
    std::optional<FrameSet> set;
    if (ahead) {
        FrameSet decoded = ahead->set.get();
        if (ahead->pulse == pulses_[place]) set = std::move(decoded);
    }
    if (!set) set = decode(pulses_[place]);
    set->complete = MonotonicClock::now();
    if (goes_back ? place > 0 : place + 1 < pulses_.size()) {
        const std::uint64_t next = pulses_[goes_back ? place - 1 : place + 1];
        const std::lock_guard lock(mutex_);
        if (!ahead_)
            ahead_ =
                Ahead{next, std::async(std::launch::async, [this, next] { return decode(next); })};
    }
    return set;
}

FrameSet TakeSets::decode(std::uint64_t pulse) const {
    std::vector<std::future<std::shared_ptr<const RigFrame>>> frames;
    for (std::size_t rig = 0; rig < rigs_.size(); ++rig)
        frames.push_back(
            std::async(std::launch::async, [this, rig, pulse] { return decode(rig, pulse); }));
    FrameSet set;
    set.trigger_index = pulse;
    for (std::size_t rig = 0; rig < rigs_.size(); ++rig) {
        std::shared_ptr<const RigFrame> frame = frames[rig].get();
        const Absence absence = frame ? Absence::none : Absence::missed_by_rig;
        set.slots.push_back({rigs_[rig]->name, std::move(frame), absence});
    }
    return set;
}

std::shared_ptr<const RigFrame> TakeSets::decode(std::size_t number, std::uint64_t pulse) const {
    const std::vector<TakeReader::Frame>& frames = take_->frames(number);
    const auto frame = std::lower_bound(
        frames.begin(), frames.end(), pulse,
        [](const TakeReader::Frame& each, std::uint64_t wanted) { return each.pulse < wanted; });
    if (frame == frames.end() || frame->pulse != pulse) return nullptr;
    Rig& rig = *rigs_[number];
    try {
        const StoredFrame stored = take_->load(number, *frame);
        const std::lock_guard lock(rig.mutex);
        return std::make_shared<const RigFrame>(rig.restorer->restore(stored));
    } catch (const Error& error) {
        const std::lock_guard lock(rig.mutex);
        if (!std::exchange(rig.is_told, true))
            log_warning("{}; vantage take check names all such places", error.what());
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

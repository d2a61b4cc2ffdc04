#include "common/receive/frame_set_assembler.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace vantage {
namespace {

/// A rig that is silent for this long does not count for the stage's step.
constexpr std::chrono::seconds silence_limit{1};
/// A rig this far behind the others is not late: it counts pulses differently.
constexpr std::chrono::seconds behind_limit{5};

/// Number of late frames in a row after which the host does not wait for a rig.
constexpr int lagging_after = 10;
/// Number of frames in a row without a pulse after which the rig counts as untriggered. A rig that
/// films faster than its trigger has such frames in between.
constexpr int pulseless_after = 10;

/// The longest expected silence of an active rig: the latency budget, and one missed pulse.
std::chrono::nanoseconds patience(const FrameSetAssembler::Options& options,
                                  std::uint32_t rate_divisor) {
    return options.latency_budget + 2 * options.period * rate_divisor;
}

}  // namespace

FrameSetAssembler::FrameSetAssembler(std::vector<std::string> rigs, const Options& options)
    : options_(options),
      step_(rigs.size(), {options.period, options.latency_budget,
                          std::max<std::chrono::nanoseconds>(silence_limit, patience(options, 1)),
                          behind_limit}) {
    for (std::string& name : rigs) {
        order_.push_back(rigs_.size());
        rigs_.emplace_back();
        rigs_.back().name = std::move(name);
    }
}

void FrameSetAssembler::add_rig(std::string name) {
    rigs_.emplace_back();
    rigs_.back().name = std::move(name);
    step_.add_rig();
    for (auto& [index, set] : open_) set.frames.resize(rigs_.size());
}

FrameFate FrameSetAssembler::add(std::size_t rig_number, std::shared_ptr<const RigFrame> frame,
                                 MonotonicTime arrival) {
    assert(rig_number < rigs_.size());
    Rig& rig = rigs_[rig_number];
    if (!frame->synchronized && order_.size() > 1) {
        rig.unsynchronized_in_a_row = std::min(rig.unsynchronized_in_a_row + 1, pulseless_after);
        return FrameFate::unsynchronized;
    }
    rig.unsynchronized_in_a_row = 0;

    const std::uint64_t index = frame->trigger_index;
    const bool new_session = rig.session && *rig.session != frame->session;
    rig.newest = index;
    rig.heard = arrival;
    rig.session = frame->session;
    const StageStep::Result step = step_.hear(rig_number, index, new_session, arrival);
    if (!first_heard_) first_heard_ = arrival;
    is_gathered_ = is_gathered_ || step_.due(index, arrival);
    if (step.began_anew || is_order_of_one_ahead(arrival)) begin_anew(arrival);
    extend_deadlines(arrival);
    if (step.verdict == StageStep::Verdict::out_of_step) return FrameFate::out_of_step;
    if (last_closed_ && index <= *last_closed_) {
        const auto closed = closed_deadlines_.find(index);
        const bool was_in_budget = closed != closed_deadlines_.end() && arrival <= closed->second;
        rig.late_in_a_row = was_in_budget ? 0 : std::min(rig.late_in_a_row + 1, lagging_after);
        return FrameFate::late;
    }
    rig.late_in_a_row = 0;

    auto [place, opened] = open_.try_emplace(index);
    OpenFrameSet& set = place->second;
    if (opened) {
        set.frames.resize(rigs_.size());
        set.opened = arrival;
        set.deadline = arrival + options_.latency_budget;
        extend_deadlines(arrival);
    }
    if (set.frames[rig_number]) return FrameFate::duplicate;
    set.frames[rig_number] = std::move(frame);
    if (open_.size() > max_open_frame_sets) close_through(open_.begin()->first, arrival);
    return FrameFate::in_frame_set;
}

bool FrameSetAssembler::is_order_of_one_ahead(MonotonicTime now) const {
    if (!last_closed_ || !is_order_of_one_) return false;
    const auto due = step_.due(*last_closed_, now);
    return due && *due > now + options_.latency_budget;
}

void FrameSetAssembler::extend_deadlines(MonotonicTime now) {
    // A rig that runs ahead must not use up the other rigs' time.
    for (auto& [index, set] : open_)
        if (const auto due = step_.due(index, now); due && *due > set.opened + options_.period)
            set.deadline = std::max(set.deadline, *due + options_.latency_budget);
}

void FrameSetAssembler::begin_anew(MonotonicTime now) {
    if (!open_.empty()) close_through(open_.rbegin()->first, now);
    last_closed_.reset();
    closed_deadlines_.clear();
    is_order_of_one_ = true;
}

std::optional<MonotonicTime> FrameSetAssembler::end_of_gathering() const {
    if (is_gathered_ || order_.size() < StageStep::fewest_to_outvote || !first_heard_)
        return std::nullopt;
    const bool any_coming = std::any_of(order_.begin(), order_.end(), [&](std::size_t rig) {
        return rigs_[rig].connected && rigs_[rig].is_coming && !rigs_[rig].newest;
    });
    return any_coming ? std::optional(*first_heard_ + longest_gathering) : std::nullopt;
}

void FrameSetAssembler::set_connected(std::size_t rig, bool connected) {
    rigs_[rig].connected = connected;
}

void FrameSetAssembler::set_asked(std::size_t rig, std::uint32_t rate_divisor) {
    rigs_[rig].rate_divisor = rate_divisor;
}

void FrameSetAssembler::set_at_stage_rate(std::size_t rig, bool is_at_it) {
    step_.set_at_stage_rate(rig, is_at_it);
}

std::vector<FrameSet> FrameSetAssembler::take_closed(MonotonicTime now) {
    std::optional<std::uint64_t> through;
    if (const auto end = end_of_gathering(); end && now < *end) return std::exchange(closed_, {});
    for (const auto& [index, set] : open_)
        if (set.deadline <= now || everyone_accounted_for(index, set, now)) through = index;
    if (through) close_through(*through, now);
    return std::exchange(closed_, {});
}

std::optional<MonotonicTime> FrameSetAssembler::next_deadline() const {
    std::optional<MonotonicTime> next;
    for (const auto& [index, set] : open_)
        next = next ? std::min(*next, set.deadline) : set.deadline;
    if (const auto end = end_of_gathering(); next && end) next = std::max(*next, *end);
    return next;
}

bool FrameSetAssembler::asked_for(std::size_t rig, std::uint64_t index) const {
    const std::uint32_t divisor = rigs_[rig].rate_divisor;
    return divisor != 0 && index % divisor == 0;
}

bool FrameSetAssembler::in_play(std::size_t number, std::uint64_t index, MonotonicTime now) const {
    const Rig& rig = rigs_[number];
    return rig.connected && rig.unsynchronized_in_a_row == 0 && rig.newest &&
           now - rig.heard <= patience(options_, rig.rate_divisor) && asked_for(number, index) &&
           !is_out_of_step(number) && !lags(number);
}

bool FrameSetAssembler::is_out_of_step(std::size_t rig) const {
    return step_.verdict(rig) == StageStep::Verdict::out_of_step;
}

bool FrameSetAssembler::lags(std::size_t rig) const {
    return rigs_[rig].late_in_a_row >= lagging_after;
}

bool FrameSetAssembler::names_no_pulse(std::size_t rig) const {
    return rigs_[rig].unsynchronized_in_a_row >= pulseless_after;
}

bool FrameSetAssembler::everyone_accounted_for(std::uint64_t index, const OpenFrameSet& set,
                                               MonotonicTime now) const {
    for (std::size_t rig = 0; rig < rigs_.size(); ++rig) {
        const bool went_past = rigs_[rig].newest && *rigs_[rig].newest > index;
        if (!set.frames[rig] && !went_past && in_play(rig, index, now)) return false;
    }
    return true;
}

Absence FrameSetAssembler::absence(std::size_t rig, std::uint64_t index) const {
    if (!rigs_[rig].connected) return Absence::disconnected;
    if (!asked_for(rig, index)) return Absence::not_asked;
    if (rigs_[rig].unsynchronized_in_a_row > 0) return Absence::unsynchronized;
    if (is_out_of_step(rig)) return Absence::out_of_step;
    if (rigs_[rig].newest && *rigs_[rig].newest > index) return Absence::missed_by_rig;
    return Absence::late;
}

void FrameSetAssembler::close_through(std::uint64_t index, MonotonicTime now) {
    while (!open_.empty() && open_.begin()->first <= index) {
        auto node = open_.extract(open_.begin());
        FrameSet set;
        set.trigger_index = node.key();
        set.complete = now;
        std::vector<std::shared_ptr<const RigFrame>>& frames = node.mapped().frames;
        for (const std::size_t rig : order_) {
            const Absence why = frames[rig] ? Absence::none : absence(rig, set.trigger_index);
            set.slots.push_back({rigs_[rig].name, std::exchange(frames[rig], nullptr), why});
        }
        for (std::size_t rig = 0; rig < rigs_.size(); ++rig)
            if (frames[rig]) set.slots.push_back({rigs_[rig].name, std::move(frames[rig])});
        last_closed_ = set.trigger_index;
        closed_deadlines_[set.trigger_index] = node.mapped().deadline;
        if (closed_deadlines_.size() > max_open_frame_sets)
            closed_deadlines_.erase(closed_deadlines_.begin());
        is_order_of_one_ = is_order_of_one_ && set.present() == 1;
        closed_.push_back(std::move(set));
    }
}

}  // namespace vantage

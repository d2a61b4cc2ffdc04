#include "rig_firmware/trigger/pulse_schedule.h"

#include <algorithm>

namespace vantage {

std::uint64_t PulseSchedule::next(TaiTime now, std::uint64_t first) {
    constexpr std::uint64_t clock_step_pulses = 2;
    const std::uint64_t passed = grid_.index_at_or_before(now);
    if (last_ && *last_ > passed + clock_step_pulses && *last_ >= first) begun_ = first;
    if (begun_ == first) first = 0;
    const std::uint64_t coming = std::max(passed + 1, first);
    if (!last_) return coming;
    if (*last_ > passed + clock_step_pulses) {
        ++clock_steps_;
        last_ = passed;
        return coming;
    }
    // A pulse that is only a little late is still sent.
    const std::uint64_t due = std::max(*last_ + 1, first);
    if (due > passed || now - grid_.time_of(due) <= late_limit_) return due;
    const bool newest_can_go = now - grid_.time_of(passed) <= late_limit_;
    const std::uint64_t chosen = newest_can_go ? passed : passed + 1;
    // Greater lateness means that the clock was set forward; it does not count as late pulses.
    constexpr std::int64_t longest_lateness_s = 10;
    if (now - grid_.time_of(due) > std::chrono::seconds(longest_lateness_s))
        ++clock_steps_;
    else
        skipped_ += chosen - due;
    last_ = chosen - 1;
    return chosen;
}

std::optional<std::chrono::nanoseconds> PulseSchedule::send(std::uint64_t index, TaiTime now) {
    last_ = index;
    const std::chrono::nanoseconds lateness = now - grid_.time_of(index);
    if (lateness > late_limit_ || lateness < -late_limit_) {
        ++skipped_;
        return std::nullopt;
    }
    ++sent_;
    return lateness;
}

}  // namespace vantage

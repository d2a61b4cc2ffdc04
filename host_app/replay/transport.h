#pragma once

#include <cstdint>
#include <optional>

#include "host_app/sets/replay_buffer.h"

namespace vantage {

/// Where in time the programme is: live, held on the instant that is shown, or at a pulse of the
/// replay buffer. Recording and what arrives go on whatever it says.
class Transport {
  public:
    void toggle_hold() { is_held_ = !is_held_; }
    /// The newest instant, from now on.
    void to_live() {
        pulse_.reset();
        is_held_ = false;
    }
    /// Goes by so many pulses, either way, from the pulse that is shown, and stays there.
    void travel(double pulses, std::uint64_t shown_pulse,
                const std::optional<ReplayBuffer::Span>& span) {
        if (!span) return;
        const double from = pulse_.value_or(static_cast<double>(shown_pulse));
        pulse_ = from + pulses;
        if (*pulse_ < static_cast<double>(span->oldest)) pulse_ = static_cast<double>(span->oldest);
        if (*pulse_ > static_cast<double>(span->newest)) pulse_ = static_cast<double>(span->newest);
    }

    bool is_live() const { return !pulse_ && !is_held_; }
    bool is_held() const { return is_held_; }
    /// In the past: the pulse.
    std::optional<double> pulse() const { return pulse_; }

  private:
    bool is_held_ = false;
    std::optional<double> pulse_;
};

}  // namespace vantage

#include "host_app/replay/transport.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vantage {
namespace {

/// As on the shuttle of a replay machine.
constexpr std::array speeds{-2.0, -1.0, -0.75, -0.5, -0.33, -0.25, -0.1, 0.0,
                            0.1,  0.25, 0.33,  0.5,  0.75,  1.0,   2.0};

/// A flight that leads further than so many pulses in a tick leads to elsewhere.
constexpr double longest_lead = 25;

}  // namespace

Transport Transport::of_take(double pulse, double speed) {
    Transport transport;
    transport.is_of_take_ = true;
    transport.state_.pulse = pulse;
    transport.state_.speed = speed;
    if (speed != 0) transport.last_speed_ = speed;
    return transport;
}

void Transport::mark(std::optional<std::uint64_t> in, std::optional<std::uint64_t> out) {
    state_.in = in;
    state_.out = out;
}

Transport::Reach Transport::reach(const PastFrameSets::Span& span) const {
    Reach reach{as_pulse(span.oldest), as_pulse(span.newest)};
    if (piece_) {
        reach.least = std::max(reach.least, piece_->least);
        reach.most = std::max(reach.least, std::min(reach.most, piece_->most));
    }
    return reach;
}

void Transport::enter(const TransportPiece& piece, double pulse, double speed, bool plays,
                      const PastFrameSets::Span& span) {
    if (!piece_) before_ = {state_.in, state_.out, state_.loops};
    piece_ = piece;
    mark(piece.in, piece.out);
    state_.loops = false;
    state_.is_held = false;
    stand_at(pulse, span);
    last_speed_ = speed;
    if (plays) state_.speed = speed;
}

void Transport::leave() {
    if (!piece_) return;
    piece_.reset();
    mark(before_.in, before_.out);
    state_.loops = before_.loops;
}

void Transport::stand_at(double pulse, const PastFrameSets::Span& span) {
    state_.speed = 0;
    is_at_end_ = false;
    overrun_s_.reset();
    go_to(pulse, span);
}

void Transport::play(double speed, std::uint64_t shown_pulse, const PastFrameSets::Span& span) {
    if (!state_.pulse) go_to(as_pulse(shown_pulse), span);
    is_at_end_ = false;
    overrun_s_.reset();
    state_.speed = last_speed_ = speed;
}

void Transport::hold_what_is_shown() {
    state_.pulse.reset();
    state_.speed = 0;
    state_.is_held = true;
}

void Transport::take(const TransportInput& input, std::uint64_t shown_pulse,
                     const std::optional<PastFrameSets::Span>& span) {
    if (input.is_any()) {
        is_at_end_ = false;
        overrun_s_.reset();
    }
    if (input.toggle_hold) toggle_hold();
    if (input.to_live) to_live();
    if (input.toggle_loop) state_.loops = !state_.loops;
    if (input.clear_marks) mark(std::nullopt, std::nullopt);
    // Where time stands its picture may be on its way yet, and what is meant is that.
    const std::uint64_t here = state_.pulse && state_.speed == 0 && !state_.is_held
                                   ? static_cast<std::uint64_t>(*state_.pulse)
                                   : shown_pulse;
    if (input.mark_in) {
        state_.in = here;
        if (state_.out && *state_.out <= here) state_.out.reset();
    }
    if (input.mark_out) {
        state_.out = here;
        if (state_.in && *state_.in >= here) state_.in.reset();
    }
    is_led_ = is_of_take_ && input.at_pulse && span;
    if (!span) return;
    // What stands keeps its picture when the buffer lets go of it.
    if (!is_of_take_ && !input.is_any() && state_.pulse && state_.speed == 0 &&
        shown_pulse < span->oldest && as_pulse(shown_pulse) <= *state_.pulse)
        hold_what_is_shown();
    if (is_led_) {
        lead(*input.at_pulse, *span);
        return;
    }
    if (input.cue) {
        state_.speed = 0;
        go_to(as_pulse(state_.in.value_or(span->oldest)), *span);
    }
    if (input.to_pulse) {
        state_.speed = 0;
        go_to(*input.to_pulse, *span);
    }
    if (input.pulses != 0) {
        state_.speed = 0;
        go_to(state_.pulse.value_or(as_pulse(shown_pulse)) + input.pulses, *span);
    }
    if (input.speed_steps != 0) {
        if (!state_.pulse) go_to(as_pulse(shown_pulse), *span);
        change_speed(input.speed_steps);
    }
}

void Transport::lead(double pulse, const PastFrameSets::Span& span) {
    const double there = std::clamp(pulse, as_pulse(span.oldest), as_pulse(span.newest));
    const double way = there - state_.pulse.value_or(there);
    is_led_on_ = way != 0;
    if (std::abs(way) > longest_lead) ++jumps_;
    state_.pulse = there;
}

void Transport::toggle_hold() {
    if (!state_.pulse) {
        state_.is_held = !state_.is_held;
        return;
    }
    if (state_.speed != 0)
        last_speed_ = std::exchange(state_.speed, 0.0);
    else
        state_.speed = last_speed_;
}

void Transport::to_live() {
    if (is_of_take_) {
        state_.speed = last_speed_ = 1;
        return;
    }
    state_.pulse.reset();
    state_.speed = 0;
    state_.is_held = false;
}

void Transport::go_to(double pulse, const PastFrameSets::Span& span) {
    const auto [least, most] = reach(span);
    state_.pulse = std::clamp(pulse, least, most);
    ++jumps_;
}

void Transport::change_speed(int steps) {
    const auto at = std::min_element(speeds.begin(), speeds.end(), [&](double a, double b) {
        return std::abs(a - state_.speed) < std::abs(b - state_.speed);
    });
    const auto wanted = (at - speeds.begin()) + steps;
    state_.speed = speeds[static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(wanted, 0, static_cast<std::ptrdiff_t>(speeds.size()) - 1))];
    if (state_.speed != 0) last_speed_ = state_.speed;
}

void Transport::arrive(double at, double again_at) {
    if (state_.loops) {
        state_.pulse = again_at;
        overrun_s_.reset();
        ++jumps_;
        return;
    }
    state_.pulse = at;
    last_speed_ = std::exchange(state_.speed, 0.0);
    is_at_end_ = true;
}

void Transport::advance(double dt_s, double pulse_rate_hz,
                        const std::optional<PastFrameSets::Span>& span) {
    if (!span || !state_.pulse || is_led_) return;
    const auto [oldest, newest] = reach(*span);
    const double before = *state_.pulse;
    if (state_.speed == 0) return;
    const double now = before + state_.speed * dt_s * pulse_rate_hz;
    const double in = state_.in ? std::max(oldest, as_pulse(*state_.in)) : oldest;
    const double last = state_.out ? std::min(newest, as_pulse(*state_.out) - 1) : newest;
    // A whole pulse is shown for a whole period. A loop is also entered from beyond its end, as
    // when its out mark is set where the programme is.
    if (state_.speed > 0 && now >= last + 1 && (before < last + 1 || state_.loops)) {
        if (!is_of_take_ && !state_.loops && !piece_ && last == newest) {
            to_live();
        } else {
            overrun_s_ = (now - (last + 1)) / (state_.speed * pulse_rate_hz);
            arrive(last, in);
        }
    } else if (state_.speed < 0 && now < in && (before >= in || state_.loops)) {
        arrive(in, last);
    } else {
        state_.pulse = std::clamp(now, oldest, newest + 1);
    }
}

}  // namespace vantage

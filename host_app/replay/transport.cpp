#include "host_app/replay/transport.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "common/base/error.h"
#include "common/base/time/timecode.h"

namespace vantage {
namespace {

/// The speeds that the shuttle of a replay machine has.
constexpr std::array speeds{-2.0, -1.0, -0.75, -0.5, -0.33, -0.25, -0.1, 0.0,
                            0.1,  0.25, 0.33,  0.5,  0.75,  1.0,   2.0};

/// A move that sets the time may go by so many pulses in a tick; more counts as a jump.
constexpr double max_lead_pulses = 25;

std::uint64_t pulse_of_seconds(const std::string& words, const PastFrameSets::Span& past,
                               double pulse_rate_hz) {
    double seconds = 0;
    const char* last = words.data() + words.size();
    const auto [end, error] = std::from_chars(words.data(), last, seconds);
    if (error != std::errc() || end != last || !std::isfinite(seconds))
        fail("'{}' is neither a time code, such as 20:15:07:12, nor seconds, such as 12.5 or -3",
             words);
    const double from = static_cast<double>(std::signbit(seconds) ? past.newest : past.oldest);
    const double there = from + seconds * pulse_rate_hz;
    if (there < static_cast<double>(past.oldest) || there > static_cast<double>(past.newest))
        fail("{} s is outside the past, which has {:.1f} s; give a time within it", words,
             static_cast<double>(past.newest - past.oldest) / pulse_rate_hz);
    return static_cast<std::uint64_t>(std::llround(there));
}

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
    const bool moves = input.moves_time();
    if (moves) {
        is_at_end_ = false;
        overrun_s_.reset();
    }
    is_led_ = is_of_take_ && input.at_pulse && span;
    if (!span) return;
    // A position that stands keeps its picture when the replay buffer drops the frame set.
    if (!is_of_take_ && !moves && state_.pulse && state_.speed == 0 && shown_pulse < span->oldest &&
        as_pulse(shown_pulse) <= *state_.pulse)
        hold_what_is_shown();
    if (is_led_) {
        lead(*input.at_pulse, *span);
        return;
    }
    if (input.to_pulse) {
        state_.speed = 0;
        go_to(*input.to_pulse, *span);
    }
    step(input.pulses, shown_pulse, *span);
}

void Transport::step(double pulses, std::uint64_t shown_pulse, const PastFrameSets::Span& span) {
    if (pulses == 0) return;
    state_.speed = 0;
    go_to(state_.pulse.value_or(as_pulse(shown_pulse)) + pulses, span);
}

std::uint64_t Transport::pulse_to_mark(std::uint64_t shown_pulse) const {
    // The picture of a position that stands may still be on its way; the mark is for the position.
    return state_.pulse && state_.speed == 0 && !state_.is_held
               ? static_cast<std::uint64_t>(*state_.pulse)
               : shown_pulse;
}

void Transport::obey(const TransportCommand& command, std::uint64_t shown_pulse,
                     const std::optional<PastFrameSets::Span>& span) {
    struct Execution {
        Transport& transport;
        std::uint64_t shown_pulse;
        const std::optional<PastFrameSets::Span>& span;
        TransportState& state = transport.state_;

        void operator()(const command::ToggleHold&) const { transport.toggle_hold(); }
        void operator()(const command::ToLive&) const { transport.to_live(); }
        void operator()(const command::ToggleLoop&) const { state.loops = !state.loops; }
        void operator()(const command::ClearMarks&) const {
            transport.mark(std::nullopt, std::nullopt);
        }
        void operator()(const command::MarkIn&) const {
            state.in = transport.pulse_to_mark(shown_pulse);
            if (state.out && *state.out <= *state.in) state.out.reset();
        }
        void operator()(const command::MarkOut&) const {
            state.out = transport.pulse_to_mark(shown_pulse);
            if (state.in && *state.in >= *state.out) state.in.reset();
        }
        void operator()(const command::CueIn&) const {
            if (!span) return;
            state.speed = 0;
            transport.go_to(as_pulse(state.in.value_or(span->oldest)), *span);
        }
        void operator()(const command::StepFrames& step) const {
            if (span) transport.step(step.frames, shown_pulse, *span);
        }
        void operator()(const command::ChangeSpeed& change) const {
            if (!span) return;
            if (!state.pulse) transport.go_to(as_pulse(shown_pulse), *span);
            transport.change_speed(change.steps);
        }
    };
    std::visit(Execution{*this, shown_pulse, span}, command);
}

void Transport::lead(double pulse, const PastFrameSets::Span& span) {
    const double there = std::clamp(pulse, as_pulse(span.oldest), as_pulse(span.newest));
    const double way = there - state_.pulse.value_or(there);
    is_led_on_ = way != 0;
    if (std::abs(way) > max_lead_pulses) ++jumps_;
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
    // Every pulse is shown for a whole period. A loop is also entered from beyond its end, as when
    // the out mark is set at the present position.
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

std::uint64_t pulse_in_past(const std::string& words, const PastFrameSets::Span& past,
                            double pulse_rate_hz, int tai_offset_s) {
    if (words.find_first_of(":;") == std::string::npos)
        return pulse_of_seconds(words, past, pulse_rate_hz);
    const TimecodeClock clock(pulse_rate_hz);
    const std::optional<TimeLabel> label = TimeLabel::parse(words);
    if (!label)
        fail("'{}' is neither a time code, such as 20:15:07:12, nor seconds, such as 12.5 or -3",
             words);
    if (const std::string why = clock.why_never(*label); !why.empty()) fail("{} {}", words, why);
    if (const auto pulse = clock.find(*label, past.oldest, past.newest, tai_offset_s))
        return *pulse;
    fail("{} is outside the past, which goes from {} to {}; give a time within it", words,
         clock.of_pulse(past.oldest, tai_offset_s), clock.of_pulse(past.newest, tai_offset_s));
}

}  // namespace vantage

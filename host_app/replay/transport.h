#pragma once

#include <cstdint>
#include <optional>

#include "host_app/frames/past_frame_sets.h"
#include "host_app/replay/transport_input.h"

namespace vantage {

/// As the place in time that it has there.
inline double as_pulse(std::uint64_t pulse) { return static_cast<double>(pulse); }

/// A part of the past that is played for itself: its marks, and how far beyond them hands may go.
struct TransportPiece {
    std::uint64_t in = 0, out = 0;  ///< `out` is the first that is left out
    double least = 0, most = 0;     ///< pulses
};

/// How it stands, for the desk.
struct TransportState {
    bool is_held = false;
    std::optional<double> pulse;  ///< nothing: live
    double speed = 0;
    std::optional<std::uint64_t> in, out;  ///< `out` is the first that is left out
    bool loops = false;
};

/// Where in time the programme is: live, held on the instant that is shown, or at a pulse of the
/// past, standing or playing at a speed from -2 to 2. The past is the replay buffer's, or a take's,
/// which has no live. Recording and what arrives go on whatever it says.
class Transport {
  public:
    Transport() = default;
    /// In a take: at the pulse, playing.
    static Transport of_take(double pulse, double speed);

    /// What hands want, of the pulse that is shown.
    void take(const TransportInput& input, std::uint64_t shown_pulse,
              const std::optional<PastFrameSets::Span>& span);
    /// Time goes by. At the out mark, or the end of what there is, it stops, or begins again at the
    /// in mark where it loops; playing that comes up to the newest pulse of a stage is live again.
    void advance(double dt_s, double pulse_rate_hz, const std::optional<PastFrameSets::Span>& span);

    /// To a pulse of the piece, whose marks stand in place of those there were; it `plays` from
    /// there or will at this speed. The piece does not loop at first.
    void enter(const TransportPiece& piece, double pulse, double speed, bool plays,
               const PastFrameSets::Span& span);
    /// The marks of before the first enter() are back; where the programme is stays.
    void leave();
    /// There, and stand.
    void stand_at(double pulse, const PastFrameSets::Span& span);
    /// At this speed from now on; from live from the pulse that is shown.
    void play(double speed, std::uint64_t shown_pulse, const PastFrameSets::Span& span);
    /// Of what plays.
    void set_speed(double speed) { state_.speed = last_speed_ = speed; }
    /// The instant that is shown, though the past may not have it any more.
    void hold_what_is_shown();

    /// From `in` to before `out`.
    void mark(std::optional<std::uint64_t> in, std::optional<std::uint64_t> out);
    void set_loop(bool loops) { state_.loops = loops; }

    bool is_of_take() const { return is_of_take_; }
    bool is_live() const { return !state_.pulse && !state_.is_held; }
    bool is_held() const { return state_.is_held; }
    /// What is shown changes by itself.
    bool is_moving() const {
        return is_live() || (is_led_ ? is_led_on_ : state_.pulse && state_.speed != 0);
    }
    /// What is shown goes on as it was, or a flight leads it, whichever way that is.
    bool is_at_normal_speed() const {
        return is_live() || (is_moving() && (is_led_ || (state_.speed == 1 && !state_.is_held)));
    }
    /// It played to an end and stopped there.
    bool is_at_end() const { return is_at_end_; }
    /// It played over the out mark, or the end, and this much further in its time.
    std::optional<double> overrun_s() const { return overrun_s_; }
    /// In the past: the pulse.
    std::optional<double> pulse() const { return state_.pulse; }
    const TransportState& state() const { return state_; }
    /// How often it went somewhere else than time does: a jog, a cue, a loop's end.
    std::uint64_t jumps() const { return jumps_; }

  private:
    /// How far hands may go.
    struct Reach {
        double least, most;
    };
    Reach reach(const PastFrameSets::Span& span) const;
    void lead(double pulse, const PastFrameSets::Span& span);
    void toggle_hold();
    void to_live();
    void go_to(double pulse, const PastFrameSets::Span& span);
    void change_speed(int steps);
    void arrive(double at, double again_at);

    /// What was before a piece was entered.
    struct Before {
        std::optional<std::uint64_t> in, out;
        bool loops = false;
    };

    TransportState state_;
    std::optional<TransportPiece> piece_;
    Before before_;  ///< of the piece
    std::optional<double> overrun_s_;
    bool is_of_take_ = false, is_at_end_ = false;
    bool is_led_ = false, is_led_on_ = false;  ///< by a flight; and it went on since the last tick
    double last_speed_ = 1;
    std::uint64_t jumps_ = 0;
};

}  // namespace vantage

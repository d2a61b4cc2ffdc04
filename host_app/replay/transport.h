#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "host_app/frames/past_frame_sets.h"
#include "host_app/replay/transport_input.h"

namespace vantage {

/// A pulse index as a playback position.
inline double as_pulse(std::uint64_t pulse) { return static_cast<double>(pulse); }

/// Part of the past that plays on its own, as a clip: its marks, and the range that the operator
/// can reach around them.
struct TransportPiece {
    std::uint64_t in = 0, out = 0;  ///< `out` is the first pulse that is left out
    double least = 0, most = 0;     ///< range in pulses
};

/// Status of the transport.
struct TransportState {
    bool is_held = false;
    std::optional<double> pulse;  ///< playback position; empty: live
    double speed = 0;
    std::optional<std::uint64_t> in, out;  ///< marks; `out` is the first pulse that is left out
    bool loops = false;
};

/// The transport of the programme, as of a replay machine: live, held on the frame set on screen,
/// or at a position of the past that stands or plays at a speed from -2 to 2. The past is the
/// replay buffer, or a take, which has no live. The transport affects neither recording nor
/// reception. Positions are pulse numbers. Not thread-safe.
class Transport {
  public:
    Transport() = default;
    /// In a take: plays from a pulse on.
    static Transport of_take(double pulse, double speed);

    /// Executes all of the input except its commands. `shown_pulse` is the pulse on screen.
    void take(const TransportInput& input, std::uint64_t shown_pulse,
              const std::optional<PastFrameSets::Span>& span);
    void obey(const TransportCommand& command, std::uint64_t shown_pulse,
              const std::optional<PastFrameSets::Span>& span);
    /// Plays on by dt_s. At the out mark or at the end of the past it stops, or starts again at the
    /// in mark if it loops. On a stage, playing up to the newest pulse returns to live.
    void advance(double dt_s, double pulse_rate_hz, const std::optional<PastFrameSets::Span>& span);

    /// Goes to a pulse of a piece. The marks of the piece replace the present ones, and the loop is
    /// switched off. It plays at `speed` if `plays`, and otherwise stands and will play at `speed`.
    void enter(const TransportPiece& piece, double pulse, double speed, bool plays,
               const PastFrameSets::Span& span);
    /// Restores the marks from before the first enter(); the position stays.
    void leave();
    /// Goes to a pulse and stops there.
    void stand_at(double pulse, const PastFrameSets::Span& span);
    /// Plays at a speed; from live it starts at the pulse on screen.
    void play(double speed, std::uint64_t shown_pulse, const PastFrameSets::Span& span);
    /// Changes the speed of playback.
    void set_speed(double speed) { state_.speed = last_speed_ = speed; }
    /// Holds the frame set on screen, even if the replay buffer has dropped it.
    void hold_what_is_shown();

    /// Sets both marks.
    void mark(std::optional<std::uint64_t> in, std::optional<std::uint64_t> out);
    void set_loop(bool loops) { state_.loops = loops; }

    bool is_of_take() const { return is_of_take_; }
    bool is_live() const { return !state_.pulse && !state_.is_held; }
    bool is_held() const { return state_.is_held; }
    /// Whether the frame set on screen changes without input.
    bool is_moving() const {
        return is_live() || (is_led_ ? is_led_on_ : state_.pulse && state_.speed != 0);
    }
    /// Whether time passes at normal speed, or a move sets it.
    bool is_at_normal_speed() const {
        return is_live() || (is_moving() && (is_led_ || (state_.speed == 1 && !state_.is_held)));
    }
    /// Whether it played to an end and stopped there.
    bool is_at_end() const { return is_at_end_; }
    /// Time by which playback passed the out mark or the end; empty: it did not.
    std::optional<double> overrun_s() const { return overrun_s_; }
    /// Position in the past; empty: live or held.
    std::optional<double> pulse() const { return state_.pulse; }
    const TransportState& state() const { return state_; }
    /// Number of jumps in time so far: by a jog, a cue, or the end of a loop.
    std::uint64_t jumps() const { return jumps_; }

  private:
    /// Range that the operator can reach.
    struct Reach {
        double least, most;
    };
    /// Marks and loop from before a piece was entered.
    struct Before {
        std::optional<std::uint64_t> in, out;
        bool loops = false;
    };
    Reach reach(const PastFrameSets::Span& span) const;
    /// Follows a move that sets the time.
    void lead(double pulse, const PastFrameSets::Span& span);
    void toggle_hold();
    void to_live();
    void step(double pulses, std::uint64_t shown_pulse, const PastFrameSets::Span& span);
    /// Pulse at which a mark is set.
    std::uint64_t pulse_to_mark(std::uint64_t shown_pulse) const;
    void go_to(double pulse, const PastFrameSets::Span& span);
    void change_speed(int steps);
    void arrive(double at, double again_at);

    TransportState state_;
    std::optional<TransportPiece> piece_;
    Before before_;
    std::optional<double> overrun_s_;
    bool is_of_take_ = false, is_at_end_ = false;
    bool is_led_ = false, is_led_on_ = false;  ///< by a move; and it moved since the last tick
    double last_speed_ = 1;
    std::uint64_t jumps_ = 0;
};

/// Parses a time in the past that an operator typed, and returns its pulse. Accepted are the time
/// code of the stage, "20:15:07:12", which without frames means the first frame of that second and
/// may end with Z or an offset from UTC ("+01:00"); seconds from the start, "12.5"; and seconds
/// before the end, "-3". The separator before the frames of a drop-frame time code may be any. In
/// the hour that occurs twice the later time is taken. `tai_offset_s` is that of TimecodeClock.
/// Throws Error if the text is none of these or the time is outside the past.
std::uint64_t pulse_in_past(const std::string& words, const PastFrameSets::Span& past,
                            double pulse_rate_hz, int tai_offset_s);

}  // namespace vantage

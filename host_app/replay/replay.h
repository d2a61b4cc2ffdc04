#pragma once

#include <memory>
#include <optional>
#include <string>

#include "host_app/replay/clip.h"
#include "host_app/replay/transport.h"

namespace vantage {

enum class ReplayMode { live, past, clip, list };
/// "live", "past", "clip", "list".
const char* name_of(ReplayMode mode);

/// Status of replay, for lamps and the desk.
struct ReplayState {
    ReplayMode mode = ReplayMode::live;
    std::shared_ptr<const ClipBook> book;          ///< immutable; replaced at every change
    int hand = 0;                                  ///< number of the selected clip; 0: none
    int clip = 0;                                  ///< the clip that is cued or playing; 0: none
    std::optional<std::size_t> selected, playing;  ///< entries of the play list
    std::optional<double> clip_left_s, list_left_s;
    bool is_at_programme_speed = false, fast_jog = false;
    std::string question;       ///< what giving the command again would do; empty: nothing
    std::string notice;         ///< last command that could not be executed, or loss
    std::uint64_t notices = 0;  ///< number of notices so far
};

/// A replay machine for a stage or a take: Transport with clips, a play list and a return to where
/// the last playback started. It never plays anything else instead of a clip that is no longer in
/// the replay buffer; it sets a notice. Used on the programme's thread only.
class Replay {
  public:
    /// Live, with an empty book.
    Replay() : Replay(Transport(), ClipBook()) {}
    Replay(Transport transport, ClipBook book);

    /// Executes operator input; `shown_pulse` is the pulse on screen.
    void take(const TransportInput& input, std::uint64_t shown_pulse,
              const std::optional<PastFrameSets::Span>& span);
    /// Plays on as Transport::advance() does, from the end of an entry to the next without a gap.
    void advance(double dt_s, double pulse_rate_hz, const std::optional<PastFrameSets::Span>& span);

    const Transport& transport() const { return transport_; }
    const ClipBook& book() const { return *book_; }
    ReplayState state() const;
    /// The shot of a clip that started since the last call; the camera is to fly to it.
    std::optional<int> take_shot() { return std::exchange(shot_, std::nullopt); }

    static constexpr double fast_jog_factor = 10;
    /// Time within which a command has to be given again to be confirmed.
    static constexpr double confirm_within_s = 3;

  private:
    using Span = std::optional<PastFrameSets::Span>;
    /// Position at which playback started.
    struct Cue {
        ReplayMode mode = ReplayMode::past;
        double pulse = 0;
        int clip = 0;           ///< for modes clip and list
        std::size_t entry = 0;  ///< for mode list
    };
    void obey(const ReplayCall& call, std::uint64_t shown_pulse, const Span& span);
    void obey_clip(const ReplayCall& call, std::uint64_t shown_pulse, const Span& span);
    void obey_list(const ReplayCall& call, const Span& span);
    void to_last_cue(const Span& span);
    void toggle_programme_speed(std::uint64_t shown_pulse, const Span& span);
    void make_clip(std::uint64_t shown_pulse);
    void trim_clip();
    void step_clip(int by);
    void delete_clip(const Span& span);
    /// Goes to a clip. False, with a notice, if the past has no part of it.
    bool enter_clip(int number, double speed, bool plays, const Span& span, double late_s = 0);
    bool begin_clip(bool plays, const Span& span);
    /// Plays the first entry from `place` on of which the past has a part.
    bool enter_entry(std::optional<std::size_t> place, const Span& span, double late_s = 0);
    void play_list(const Span& span);
    void remove_entry(const Span& span);
    /// After the playing entry was removed: plays the one in its place, or stops.
    void replace_playing(const Span& span);
    /// Reacts to the end of a clip, and to its loss from the replay buffer.
    void follow_piece(const PastFrameSets::Span& span);
    void hold_lost();
    void leave_piece();
    /// Applies a changed speed of a clip or an entry.
    void follow_speed();
    double speed_of(const PlayEntry& entry) const;
    double left_s_of(const PlayEntry& entry) const;
    bool plays() const { return transport_.pulse() && transport_.state().speed != 0; }
    ReplayMode mode() const;
    Clip* held_clip(ClipBook& book) const;
    /// Whether the same question was asked before and is still open; otherwise it is asked now.
    bool confirms(std::string question);
    void notify(std::string notice);
    void obey_transport(const TransportCommand& command, std::uint64_t shown_pulse,
                        const Span& span);
    /// Remembers the position if playback started.
    void note_start(bool was_playing);
    template <class Change>
    void edit(const Change& change);

    Transport transport_;
    std::shared_ptr<const ClipBook> book_;
    PlayList list_;
    int hand_ = 0, clip_ = 0;
    bool fast_jog_ = false;
    bool is_loss_reported_ = false;  ///< of the beginning of the clip that is playing
    bool is_list_over_ = false;      ///< the last entry was played to its end
    std::optional<Cue> last_cue_;
    std::optional<int> shot_;
    double time_s_ = 0, question_until_s_ = 0;
    std::string question_, notice_;
    std::uint64_t notices_ = 0;
};

}  // namespace vantage

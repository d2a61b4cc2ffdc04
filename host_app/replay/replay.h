#pragma once

#include <memory>
#include <optional>
#include <string>

#include "host_app/replay/clip.h"
#include "host_app/replay/play_list.h"
#include "host_app/replay/transport.h"

namespace vantage {

enum class ReplayMode { live, past, clip, list };
/// "live", "past", "clip", "list".
const char* name_of(ReplayMode mode);

/// How replay stands, for lamps and the desk.
struct ReplayState {
    ReplayMode mode = ReplayMode::live;
    std::shared_ptr<const ClipBook> book;          ///< another one whenever it is changed
    int hand = 0;                                  ///< the clip in hand; 0: none
    int clip = 0;                                  ///< that is cued or played; 0: none
    std::optional<std::size_t> selected, playing;  ///< places in the list
    std::optional<double> clip_left_s, list_left_s;
    bool is_at_programme_speed = false, fast_jog = false;
    std::string question;       ///< that giving the same again answers; empty: none
    std::string notice;         ///< what could not be done last, or was lost
    std::uint64_t notices = 0;  ///< so far
};

/// A replay machine over the past of a stage or a take: Transport with clips, a play list and the
/// way back to where the last playback began. Of the programme's thread; it plays nothing that was
/// not asked for, and says so where what was asked for is not there any more.
class Replay {
  public:
    /// On a live stage, with a book of its own pulse rate.
    Replay() : Replay(Transport(), ClipBook()) {}
    Replay(Transport transport, ClipBook book);

    /// What hands want, of the pulse that is shown.
    void take(const TransportInput& input, std::uint64_t shown_pulse,
              const std::optional<PastFrameSets::Span>& span);
    /// Time goes by: see Transport; from the end of an entry to the next one without a gap.
    void advance(double dt_s, double pulse_rate_hz, const std::optional<PastFrameSets::Span>& span);

    const Transport& transport() const { return transport_; }
    const ClipBook& book() const { return *book_; }
    ReplayState state() const;
    /// The shot that the camera is to fly to with what was begun since the last call.
    std::optional<int> take_shot() { return std::exchange(shot_, std::nullopt); }

    static constexpr double fast_jog_times = 10;
    /// How long a question stands.
    static constexpr double asks_for_s = 3;

  private:
    using Span = std::optional<PastFrameSets::Span>;
    /// Where playing began.
    struct Cue {
        ReplayMode mode = ReplayMode::past;
        double pulse = 0;
        int clip = 0;           ///< of a clip
        std::size_t entry = 0;  ///< of a list
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
    /// False, and it is said why: there is nothing of it.
    bool enter_clip(int number, double speed, bool plays, const Span& span, double late_s = 0);
    bool begin_clip(bool plays, const Span& span);
    /// The first entry from `place` on that there is something of.
    bool enter_entry(std::optional<std::size_t> place, const Span& span, double late_s = 0);
    void play_list(const Span& span);
    void remove_entry(const Span& span);
    /// Of the list, one that plays no more: the one that stands in its place, or nothing.
    void replace_playing(const Span& span);
    /// What plays has come to its end, or is lost to the buffer.
    void follow_piece(const PastFrameSets::Span& span);
    void hold_lost();
    void leave_piece();
    /// What is cued or played is played at what its entry or clip says now.
    void follow_speed();
    double speed_of(const PlayEntry& entry) const;
    double left_s_of(const PlayEntry& entry) const;
    bool plays() const { return transport_.pulse() && transport_.state().speed != 0; }
    ReplayMode mode() const;
    Clip* held_clip(ClipBook& book) const;
    /// Whether this question stands already; else it does from now on.
    bool confirms(std::string question);
    void say(std::string notice);
    template <class Change>
    void edit(const Change& change);

    Transport transport_;
    std::shared_ptr<const ClipBook> book_;
    PlayList list_;
    int hand_ = 0, clip_ = 0;
    bool fast_jog_ = false;
    bool is_told_of_loss_ = false;  ///< of a part of what plays
    bool is_list_over_ = false;     ///< it stands at the end of its last entry
    std::optional<Cue> last_cue_;
    std::optional<int> shot_;
    double time_s_ = 0, question_until_s_ = 0;
    std::string question_, notice_;
    std::uint64_t notices_ = 0;
};

}  // namespace vantage

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "host_app/control/table/control_command.h"

namespace vantage {

/// What there is to show of a session, as far as a desk's lamps go.
struct ShowLamps {
    bool live = false, hold = false;
    double speed = 0;     ///< of time: 1 live, 0 held
    double behind_s = 0;  ///< of live
    bool mark_in = false, mark_out = false, loops = false;
    bool take = false, film = false;
    double set = -1;  ///< 0..1 known, of the rig that knows least; -1: none is learnt
    std::string saved_background;
    bool programme_tally = false, preview_tally = false;
    bool input_flies_preview = false;   ///< hands fly a camera on preview
    double fly_to_preview = -1;   ///< 0..1; -1: not under way
    double fly_to_preview_s = 0;  ///< that it takes
    bool tracked = false;         ///< a tracked camera flies
    bool source_map = false;
    double move = -1;      ///< 0..1 along the planned move; -1: not on it
    double keyframes = 0;  ///< that the move has
    bool record = false;   ///< a flight is recorded
    bool horizon = false, follow = false;
    double coverage = -1;  ///< 0..1; -1: not known
    std::string wheel_mode, synthesiser, timecode;
    double render_level = 0, prepare_level = 0;
    double repeated_ticks = 0;
    std::string replay_mode;                          ///< live, past, clip or list
    std::string pulse;                                ///< of the picture
    double clip = 0, played_clip = 0, clips = 0;      ///< numbers; 0: none
    double entry = 0, played_entry = 0, entries = 0;  ///< places from 1 on; 0: none
    double clip_left_s = -1, list_left_s = -1;        ///< -1: none plays
    double preset_percent = 0;
    bool list_loops = false, programme_speed = false, fast_jog = false;
    bool at_in = false, at_out = false;  ///< the picture is that of the mark
    std::string notice, question;
    std::array<std::string, 8> outputs;  ///< their states; empty: there is none
};

using LampValue = std::variant<bool, double, std::string>;

/// Something that a desk can show: a lamp that is on or off, a level, a word.
struct Lamp {
    const char* name;
    const char* says;
    LampValue (*of)(const ShowLamps& show);
    ControlPage page = ControlPage::control;
};

/// All of them, in the order in which people are shown them.
std::span<const Lamp> lamps();

/// "switch", "number", "word".
const char* kind_words(const Lamp& lamp);

}  // namespace vantage

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_app/control/table/control_command.h"

namespace vantage {

/// Values of all lamps of a session.
struct ShowLamps {
    bool live = false, hold = false;
    double speed = 0;  ///< of playback: 1 live, 0 held
    double behind_s = 0;
    bool mark_in = false, mark_out = false, loops = false;
    bool take = false, film = false;
    double background = -1;  ///< known share 0..1, of the rig with the least; -1: none is learnt
    std::string saved_background;
    std::string stage;  ///< result of the last reload of the stage file; empty: none
    bool programme_tally = false, preview_tally = false;
    bool input_flies_preview = false;
    double fly_to_preview = -1;   ///< progress 0..1; -1: no such flight
    double fly_to_preview_s = 0;  ///< its duration
    bool tracked = false;         ///< a tracked camera flies
    bool source_map = false;
    double move = -1;      ///< progress 0..1; -1: not on the move
    double keyframes = 0;  ///< of the move
    bool record = false;   ///< a flight is recorded
    bool horizon = false, follow = false;
    double coverage = -1;  ///< 0..1; -1: not known
    std::string wheel_mode, synthesiser, timecode;
    double render_level = 0, prepare_level = 0;
    double repeated_ticks = 0;
    bool fit_for_air = false;             ///< the verdict is READY
    std::string verdict, verdict_reason;  ///< ready, caution or not_ready; empty: not known yet
    std::string replay_mode;              ///< live, past, clip or list
    std::string pulse;                    ///< index of the picture's pulse
    double clip = 0, played_clip = 0, clips = 0;      ///< numbers; 0: none
    double entry = 0, played_entry = 0, entries = 0;  ///< places from 1; 0: none
    double clip_left_s = -1, list_left_s = -1;        ///< -1: nothing plays
    double preset_percent = 0;
    bool list_loops = false, programme_speed = false, fast_jog = false;
    bool at_in = false, at_out = false;  ///< the picture is the mark's
    std::string notice, question;
    std::array<std::string, 8> outputs;  ///< states; empty: no such output
};

using LampValue = std::variant<bool, double, std::string>;

/// A row of the table of lamps: a value that control surfaces show, as a switch, a number or a
/// word.
struct Lamp {
    const char* name;
    const char* says;  ///< its meaning; empty: a row of a series that the row before describes
    LampValue (*of)(const ShowLamps& show);
    ControlPage page = ControlPage::control;
    const char* old_name = "";  ///< name in earlier versions, which still works; empty: none
};

/// All lamps, in the order in which documents list them.
std::span<const Lamp> lamps();

/// Type of a lamp's value: "switch", "number" or "word".
const char* kind_words(const Lamp& lamp);

/// The tables of commands and lamps in docs/operate/control.md and docs/reference/commands.md, as
/// Markdown.
std::string command_table(ControlPage page);
std::string lamp_table(ControlPage page);
/// Both tables for `vantage control --json`.
nlohmann::ordered_json control_json();

}  // namespace vantage

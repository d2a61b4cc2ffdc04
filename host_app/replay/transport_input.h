#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace vantage {

/// Commands are values: a struct for each, with its arguments. Transport executes the ones here.
namespace command {

struct ToggleHold {};  ///< live: hold the frame set on screen; in the past: pause or play
struct ToLive {};      ///< live; in a take: normal speed
/// Go by so many frames, negative backwards, and stop there.
struct StepFrames {
    double frames = 0;
};
/// Go to the next faster (positive) or slower speeds of the shuttle.
struct ChangeSpeed {
    int steps = 0;
};
struct MarkIn {};
struct MarkOut {};
struct ClearMarks {};
struct ToggleLoop {};
struct CueIn {};  ///< go to the in mark and stop there

}  // namespace command

using TransportCommand = std::variant<command::ToggleHold, command::ToLive, command::StepFrames,
                                      command::ChangeSpeed, command::MarkIn, command::MarkOut,
                                      command::ClearMarks, command::ToggleLoop, command::CueIn>;

/// A command for clips, play list and playback, which Replay executes.
enum class ReplayAction {
    last_cue,
    programme_speed,
    preset_speed,  ///< `number` is in per cent
    fast_jog,
    make_clip,
    trim_clip,
    hold_clip,  ///< select clip `number`
    clip_step,  ///< select the clip `number` further on, or back
    cue_clip,
    play_clip,
    clip_speed,  ///< in per cent
    clip_shot,
    name_clip,  ///< `words`
    delete_clip,
    play_list,
    next_entry,
    loop_list,
    add_entry,
    remove_entry,
    select_entry,
    entry_step,  ///< select the entry `number` further down, or up
    move_entry,  ///< by `number` places
    swap_entry,  ///< with entry `number`
    entry_speed  ///< in per cent
};

struct ReplayCall {
    ReplayAction action{};
    int number = 0;
    std::string words = {};
};

using TimeCommand = std::variant<TransportCommand, ReplayCall>;

/// Operator input for the playback position in one tick. Positions are pulse numbers.
struct TransportInput {
    std::optional<double> to_pulse = {};  ///< go to this pulse and stop there
    double pulses = 0;                    ///< jog, negative backwards
    double shuttle_pulses = 0;            ///< way that a spring-loaded ring asks for in this tick
    /// Pulse of a take that the planned move sets at this time; empty: the transport runs freely.
    std::optional<double> at_pulse{};
    /// Executed in order, after the jog.
    std::vector<TimeCommand> commands = {};

    /// Whether the input changes the playback position or its speed; marks alone do not.
    bool moves_time() const {
        constexpr auto moves = [](const TimeCommand& each) {
            const auto* transport = std::get_if<TransportCommand>(&each);
            return !transport || !(std::holds_alternative<command::MarkIn>(*transport) ||
                                   std::holds_alternative<command::MarkOut>(*transport) ||
                                   std::holds_alternative<command::ClearMarks>(*transport) ||
                                   std::holds_alternative<command::ToggleLoop>(*transport));
        };
        return to_pulse || pulses != 0 || shuttle_pulses != 0 ||
               std::any_of(commands.begin(), commands.end(), moves);
    }
};

}  // namespace vantage

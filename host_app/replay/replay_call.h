#pragma once

#include <string>

namespace vantage {

/// What hands ask of clips, play list and playback, beside what TransportInput has of time itself.
enum class ReplayAction {
    last_cue,
    programme_speed,
    preset_speed,  ///< `number` is per cent
    fast_jog,
    make_clip,
    trim_clip,
    hold_clip,  ///< take clip `number` in hand
    clip_step,  ///< the clip `number` further on, or back
    cue_clip,
    play_clip,
    clip_speed,  ///< per cent
    clip_shot,
    name_clip,  ///< `words`
    delete_clip,
    play_list,
    next_entry,
    loop_list,
    add_entry,
    remove_entry,
    select_entry,
    entry_step,  ///< the entry `number` further down, or up
    move_entry,  ///< by `number` places
    swap_entry,  ///< with the entry `number`
    entry_speed  ///< per cent
};

struct ReplayCall {
    ReplayAction action{};
    int number = 0;
    std::string words = {};
};

}  // namespace vantage

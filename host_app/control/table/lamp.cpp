#include "host_app/control/table/lamp.h"

#include <fmt/format.h>

namespace vantage {
namespace {

using Show = ShowLamps;
constexpr ControlPage replay_page = ControlPage::replay;

template <int number>
LampValue output_state(const Show& show) {
    return show.outputs[number - 1];
}

constexpr Lamp lamp_table_rows[] = {
    {"live", "the programme is live", [](const Show& s) { return LampValue(s.live); }, replay_page},
    {"hold", "the picture stands: frozen, or paused in the past",
     [](const Show& s) { return LampValue(s.hold); }, replay_page},
    {"speed", "speed of playback: 1 live, 0 held, -2 to 2 in the past",
     [](const Show& s) { return LampValue(s.speed); }, replay_page},
    {"behind", "seconds behind live", [](const Show& s) { return LampValue(s.behind_s); },
     replay_page},
    {"mark_in", "the in mark is set", [](const Show& s) { return LampValue(s.mark_in); },
     replay_page},
    {"mark_out", "the out mark is set", [](const Show& s) { return LampValue(s.mark_out); },
     replay_page},
    {"loop", "playback loops between the marks", [](const Show& s) { return LampValue(s.loops); },
     replay_page},
    {"timecode", "time code of the picture, four times a second",
     [](const Show& s) { return LampValue(s.timecode); }, replay_page},
    {"pulse", "pulse index of the picture", [](const Show& s) { return LampValue(s.pulse); },
     replay_page},
    {"replay", "live, past, clip or list", [](const Show& s) { return LampValue(s.replay_mode); },
     replay_page},
    {"at_in", "the picture is the in mark's", [](const Show& s) { return LampValue(s.at_in); },
     replay_page},
    {"at_out", "the picture is the out mark's", [](const Show& s) { return LampValue(s.at_out); },
     replay_page},
    {"programme_speed", "playback has the programme speed",
     [](const Show& s) { return LampValue(s.programme_speed); }, replay_page},
    {"preset", "the programme speed in per cent",
     [](const Show& s) { return LampValue(s.preset_percent); }, replay_page},
    {"fast_jog", "frames and wheel steps count ten times",
     [](const Show& s) { return LampValue(s.fast_jog); }, replay_page},
    {"clip", "number of the selected clip; 0: none",
     [](const Show& s) { return LampValue(s.clip); }, replay_page},
    {"played_clip", "number of the clip that is cued or playing; 0: none",
     [](const Show& s) { return LampValue(s.played_clip); }, replay_page},
    {"clip_left", "seconds to the end of that clip; -1: none",
     [](const Show& s) { return LampValue(s.clip_left_s); }, replay_page},
    {"clips", "number of clips", [](const Show& s) { return LampValue(s.clips); }, replay_page},
    {"entry", "place of the selected entry; 0: none",
     [](const Show& s) { return LampValue(s.entry); }, replay_page},
    {"played_entry", "place of the entry that is playing; 0: none",
     [](const Show& s) { return LampValue(s.played_entry); }, replay_page},
    {"list_left", "seconds to the end of the play list; -1: none",
     [](const Show& s) { return LampValue(s.list_left_s); }, replay_page},
    {"entries", "number of entries in the play list",
     [](const Show& s) { return LampValue(s.entries); }, replay_page},
    {"list_loop", "the play list starts again at its end",
     [](const Show& s) { return LampValue(s.list_loops); }, replay_page},
    {"question", "effect of giving the last command again",
     [](const Show& s) { return LampValue(s.question); }, replay_page},
    {"notice", "last command that replay could not execute, or loss",
     [](const Show& s) { return LampValue(s.notice); }, replay_page},
    {"take", "a take is being recorded", [](const Show& s) { return LampValue(s.take); }},
    {"background",
     "known share 0 to 1 of the background, of the rig with the least; -1: none is learnt",
     [](const Show& s) { return LampValue(s.background); }, ControlPage::control,
     "set"},  // old name
    {"saved_background", "file to which the background was saved last",
     [](const Show& s) { return LampValue(s.saved_background); }, ControlPage::control,
     "saved_set"},  // old name
    {"stage", "result of the last reload of the stage file",
     [](const Show& s) { return LampValue(s.stage); }},
    {"film", "a film is being recorded", [](const Show& s) { return LampValue(s.film); }},
    {"programme", "tally: the mixer has this camera on air",
     [](const Show& s) { return LampValue(s.programme_tally); }},
    {"preview", "tally: the mixer has this camera on preview",
     [](const Show& s) { return LampValue(s.preview_tally); }},
    {"preview_camera", "there is a camera on preview, which the operator flies",
     [](const Show& s) { return LampValue(s.input_flies_preview); }, ControlPage::control,
     "hands_preview"},  // old name
    {"auto", "progress 0 to 1 of the flight to the preview; -1: none",
     [](const Show& s) { return LampValue(s.fly_to_preview); }},
    {"auto_time", "duration of that flight in seconds",
     [](const Show& s) { return LampValue(s.fly_to_preview_s); }},
    {"tracking", "a tracked camera (FreeD) flies",
     [](const Show& s) { return LampValue(s.tracked); }},
    {"source_map", "the source map is shown",
     [](const Show& s) { return LampValue(s.source_map); }},
    {"move", "progress 0 to 1 along the planned move; -1: not on the move",
     [](const Show& s) { return LampValue(s.move); }},
    {"keyframes", "number of keyframes of the move",
     [](const Show& s) { return LampValue(s.keyframes); }},
    {"record", "a flight is being recorded", [](const Show& s) { return LampValue(s.record); }},
    {"horizon", "the horizon is held level", [](const Show& s) { return LampValue(s.horizon); }},
    {"follow", "the pivot follows a performer", [](const Show& s) { return LampValue(s.follow); }},
    {"coverage", "share 0 to 1 of the picture that the rigs cover; -1: unknown",
     [](const Show& s) { return LampValue(s.coverage); }},
    {"wheel", "target of the wheels: orbit, move or past",
     [](const Show& s) { return LampValue(s.wheel_mode); }},
    {"synthesiser", "name of the synthesiser",
     [](const Show& s) { return LampValue(s.synthesiser); }},
    {"render_level", "render level; 0 is the best",
     [](const Show& s) { return LampValue(s.render_level); }},
    {"prepare_level", "prepare level; 0 is the best",
     [](const Show& s) { return LampValue(s.prepare_level); }},
    {"repeated", "number of ticks that repeated a frame",
     [](const Show& s) { return LampValue(s.repeated_ticks); }},
    {"ready", "the programme may go on air: the verdict is READY",
     [](const Show& s) { return LampValue(s.fit_for_air); }},
    {"verdict", "whether the programme may go on air: ready, caution or not_ready",
     [](const Show& s) { return LampValue(s.verdict); }},
    {"verdict_reason", "the most serious reason of the verdict; empty: none",
     [](const Show& s) { return LampValue(s.verdict_reason); }},
    {"output/1", "state of output 1 (and so on to output/8)", output_state<1>},
    {"output/2", "", output_state<2>},
    {"output/3", "", output_state<3>},
    {"output/4", "", output_state<4>},
    {"output/5", "", output_state<5>},
    {"output/6", "", output_state<6>},
    {"output/7", "", output_state<7>},
    {"output/8", "", output_state<8>}};

}  // namespace

std::span<const Lamp> lamps() { return lamp_table_rows; }

const char* kind_words(const Lamp& lamp) {
    const LampValue value = lamp.of({});
    if (std::holds_alternative<bool>(value)) return "switch";
    return std::holds_alternative<double>(value) ? "number" : "word";
}

std::string command_table(ControlPage page) {
    std::string text = "| command | action | key | lamp |\n| --- | --- | --- | --- |\n";
    for (const ControlCommand& command : control_commands())
        if (command.page == page)
            text += fmt::format("| {}{} | {} | {} | {} |\n", command.name, argument_words(command),
                                command.does, key_words(command), command.lamp);
    return text;
}

std::string lamp_table(ControlPage page) {
    std::string text = "| lamp | meaning | type |\n| --- | --- | --- |\n";
    for (const Lamp& lamp : lamps())
        if (*lamp.says && lamp.page == page)
            text += fmt::format("| {} | {} | {} |\n", lamp.name, lamp.says, kind_words(lamp));
    return text;
}

nlohmann::ordered_json control_json() {
    nlohmann::ordered_json json;
    for (const ControlCommand& command : control_commands()) {
        nlohmann::ordered_json entry{{"name", command.name}, {"does", command.does}};
        if (command.argument == CommandArgument::words) entry["words"] = command.argument_name;
        if (command.argument == CommandArgument::number) entry["most"] = command.max_number;
        if (command.argument == CommandArgument::steps) entry["most_steps"] = most_steps;
        if (*command.old_name) entry["old_name"] = command.old_name;
        if (const std::string key = key_words(command); !key.empty()) entry["key"] = key;
        if (*command.lamp) entry["lamp"] = command.lamp;
        json["commands"].push_back(std::move(entry));
    }
    for (const Lamp& lamp : lamps()) {
        json["lamps"].push_back(
            {{"name", lamp.name}, {"says", lamp.says}, {"is", kind_words(lamp)}});
        if (*lamp.old_name) json["lamps"].back()["old_name"] = lamp.old_name;
    }
    return json;
}

}  // namespace vantage

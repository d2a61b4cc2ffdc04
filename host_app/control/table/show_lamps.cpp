#include "host_app/control/table/lamp_parts.h"

namespace vantage {
namespace {

using Show = ShowLamps;
template <int number>
LampValue output_state(const Show& show) {
    return show.outputs[number - 1];
}

constexpr Lamp all[] = {
    {"take", "a take is recorded", [](const Show& s) { return LampValue(s.take); }},
    {"set", "0 to 1 of the set that is known, of the rig that knows least; -1 none is learnt",
     [](const Show& s) { return LampValue(s.set); }},
    {"saved_set", "file that the set was saved to last",
     [](const Show& s) { return LampValue(s.saved_background); }},
    {"film", "a film is recorded", [](const Show& s) { return LampValue(s.film); }},
    {"programme", "tally: the mixer has this camera on air",
     [](const Show& s) { return LampValue(s.programme_tally); }},
    {"preview", "tally: the mixer has it on preview",
     [](const Show& s) { return LampValue(s.preview_tally); }},
    {"hands_preview", "hands fly a camera on preview",
     [](const Show& s) { return LampValue(s.input_flies_preview); }},
    {"auto", "0 to 1 of that flight; -1 off it",
     [](const Show& s) { return LampValue(s.fly_to_preview); }},
    {"auto_time", "seconds that it takes",
     [](const Show& s) { return LampValue(s.fly_to_preview_s); }},
    {"tracking", "a tracked camera (FreeD) flies",
     [](const Show& s) { return LampValue(s.tracked); }},
    {"source_map", "pixels are shown by rig",
     [](const Show& s) { return LampValue(s.source_map); }},
    {"move", "0 to 1 along the planned move; -1 off it",
     [](const Show& s) { return LampValue(s.move); }},
    {"keyframes", "keyframes that the move has",
     [](const Show& s) { return LampValue(s.keyframes); }},
    {"record", "a flight is recorded", [](const Show& s) { return LampValue(s.record); }},
    {"horizon", "the horizon is held level", [](const Show& s) { return LampValue(s.horizon); }},
    {"follow", "the pivot goes with a performer",
     [](const Show& s) { return LampValue(s.follow); }},
    {"coverage", "0 to 1 of the picture that the rigs cover; -1 unknown",
     [](const Show& s) { return LampValue(s.coverage); }},
    {"wheel", "what wheels drive: orbit, move or past",
     [](const Show& s) { return LampValue(s.wheel_mode); }},
    {"synthesiser", "the synthesiser", [](const Show& s) { return LampValue(s.synthesiser); }},
    {"render_level", "quality of rendering; 0 is the best",
     [](const Show& s) { return LampValue(s.render_level); }},
    {"prepare_level", "quality of preparing; 0 is the best",
     [](const Show& s) { return LampValue(s.prepare_level); }},
    {"repeated", "ticks that repeated a picture",
     [](const Show& s) { return LampValue(s.repeated_ticks); }},
    {"output/1", "state of output 1 (and so on to output/8)", output_state<1>},
    {"output/2", "", output_state<2>},
    {"output/3", "", output_state<3>},
    {"output/4", "", output_state<4>},
    {"output/5", "", output_state<5>},
    {"output/6", "", output_state<6>},
    {"output/7", "", output_state<7>},
    {"output/8", "", output_state<8>}};

}  // namespace

std::span<const Lamp> show_lamps() { return all; }

}  // namespace vantage

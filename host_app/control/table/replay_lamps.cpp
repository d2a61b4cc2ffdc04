#include "host_app/control/table/lamp_parts.h"

namespace vantage {
namespace {

using Show = ShowLamps;
constexpr ControlPage page = ControlPage::replay;

constexpr Lamp all[] = {
    {"live", "the programme shows what happens now",
     [](const Show& s) { return LampValue(s.live); }, page},
    {"hold", "it stands: frozen, or stopped in the past",
     [](const Show& s) { return LampValue(s.hold); }, page},
    {"speed", "of time: 1 live, 0 held, -2 to 2 in the past",
     [](const Show& s) { return LampValue(s.speed); }, page},
    {"behind", "seconds behind live", [](const Show& s) { return LampValue(s.behind_s); }, page},
    {"mark_in", "there is an in mark", [](const Show& s) { return LampValue(s.mark_in); }, page},
    {"mark_out", "there is an out mark", [](const Show& s) { return LampValue(s.mark_out); }, page},
    {"loop", "it loops between them", [](const Show& s) { return LampValue(s.loops); }, page},
    {"timecode", "of the picture, four times a second",
     [](const Show& s) { return LampValue(s.timecode); }, page},
    {"pulse", "index of the pulse of the picture", [](const Show& s) { return LampValue(s.pulse); },
     page},
    {"replay", "live, past, clip or list", [](const Show& s) { return LampValue(s.replay_mode); },
     page},
    {"at_in", "the picture is that of the in mark",
     [](const Show& s) { return LampValue(s.at_in); }, page},
    {"at_out", "it is that of the out mark", [](const Show& s) { return LampValue(s.at_out); },
     page},
    {"programme_speed", "it plays at the programme speed",
     [](const Show& s) { return LampValue(s.programme_speed); }, page},
    {"preset", "the programme speed, per cent",
     [](const Show& s) { return LampValue(s.preset_percent); }, page},
    {"fast_jog", "frames and steps count ten times",
     [](const Show& s) { return LampValue(s.fast_jog); }, page},
    {"clip", "number of the clip in hand; 0 none", [](const Show& s) { return LampValue(s.clip); },
     page},
    {"played_clip", "number of the clip that is cued or played; 0 none",
     [](const Show& s) { return LampValue(s.played_clip); }, page},
    {"clip_left", "seconds until its out; -1 none",
     [](const Show& s) { return LampValue(s.clip_left_s); }, page},
    {"clips", "clips that there are", [](const Show& s) { return LampValue(s.clips); }, page},
    {"entry", "place of the selected entry; 0 none",
     [](const Show& s) { return LampValue(s.entry); }, page},
    {"played_entry", "place of the entry that plays; 0 none",
     [](const Show& s) { return LampValue(s.played_entry); }, page},
    {"list_left", "seconds until the end of the list; -1 none",
     [](const Show& s) { return LampValue(s.list_left_s); }, page},
    {"entries", "entries that the list has", [](const Show& s) { return LampValue(s.entries); },
     page},
    {"list_loop", "the list begins again at its end",
     [](const Show& s) { return LampValue(s.list_loops); }, page},
    {"question", "what giving the same again would do",
     [](const Show& s) { return LampValue(s.question); }, page},
    {"notice", "what replay could not do last, or lost",
     [](const Show& s) { return LampValue(s.notice); }, page}};

}  // namespace

std::span<const Lamp> replay_lamps() { return all; }

}  // namespace vantage

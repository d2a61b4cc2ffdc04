#include "host_app/desk/feed/desk_replay.h"

#include <iterator>

#include <fmt/format.h>

#include "common/base/time/timecode.h"

namespace vantage {
namespace {

const char* loss_of(ClipPresence presence) {
    switch (presence) {
        case ClipPresence::whole:
            break;
        case ClipPresence::part:
            return "PART GONE";
        case ClipPresence::gone:
            return "GONE";
    }
    return "";
}

}  // namespace

DeskReplay desk_replay(const ProgrammeState& programme, const ClipPictures& pictures,
                       int tai_offset_s) {
    const ReplayState& replay = programme.replay;
    DeskReplay desk;
    if (!replay.book) return desk;
    const ClipBook& book = *replay.book;
    const TimecodeClock clock(book.pulse_rate_hz);
    for (const auto& [number, clip] : book.clips) {
        DeskClip& shown = desk.clips.emplace_back();
        shown.number = number;
        // As far as a place of the bin is wide.
        shown.name =
            clip.name.empty()
                ? clock.of_pulse(clip.in, tai_offset_s).substr(0, std::size("hh:mm:ss") - 1)
                : clip.name;
        shown.in = static_cast<double>(clip.in);
        shown.out = static_cast<double>(clip.out);
        shown.speed = clip.speed;
        shown.duration_s = clip.duration_s(book.pulse_rate_hz);
        shown.is_in_hand = number == replay.hand;
        shown.is_played = number == replay.clip;
        shown.loss = loss_of(presence_of(clip, programme.past));
        shown.picture = pictures.of(number);
    }
    for (std::size_t place = 0; place < book.list.size(); ++place) {
        const PlayEntry& entry = book.list[place];
        const Clip& clip = book.clips.at(entry.clip);
        DeskEntry& shown = desk.entries.emplace_back();
        const std::string in = clock.of_pulse(clip.in, tai_offset_s);
        shown.name = clip.name.empty() ? fmt::format("{}  {}", entry.clip, in)
                                       : fmt::format("{} {}  {}", entry.clip, clip.name, in);
        shown.speed = entry.speed.value_or(clip.speed);
        shown.duration_s = clip.duration_s(book.pulse_rate_hz) / shown.speed;
        shown.is_selected = replay.selected == place;
        shown.is_playing = replay.playing == place;
        shown.is_gone = presence_of(clip, programme.past) == ClipPresence::gone;
    }
    desk.list_loops = book.list_loops;
    desk.programme_speed = book.programme_speed;
    desk.clip = replay.clip;
    desk.clip_left_s = replay.clip_left_s;
    desk.list_left_s = replay.list_left_s;
    desk.fast_jog = replay.fast_jog;
    return desk;
}

}  // namespace vantage

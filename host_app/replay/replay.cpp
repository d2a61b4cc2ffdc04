#include "host_app/replay/replay.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "common/base/counted.h"

namespace vantage {
namespace {

constexpr double per_cent = 100;

std::string words_of(int number, const Clip& clip) {
    return clip.name.empty() ? fmt::format("clip {}", number)
                             : fmt::format("clip {} \"{}\"", number, clip.name);
}

}  // namespace

const char* name_of(ReplayMode mode) {
    switch (mode) {
        case ReplayMode::live:
            break;
        case ReplayMode::past:
            return "past";
        case ReplayMode::clip:
            return "clip";
        case ReplayMode::list:
            return "list";
    }
    return "live";
}

Replay::Replay(Transport transport, ClipBook book)
    : transport_(transport),
      book_(std::make_shared<const ClipBook>(std::move(book))),
      list_(book_->list) {
    if (!book_->clips.empty()) hand_ = book_->clips.begin()->first;
    if (plays()) last_cue_ = Cue{ReplayMode::past, *transport_.pulse()};
}

template <class Change>
void Replay::edit(const Change& change) {
    ClipBook book = *book_;
    change(book);
    book.list = list_.entries();
    if (book != *book_) book_ = std::make_shared<const ClipBook>(std::move(book));
}

void Replay::notify(std::string notice) {
    notice_ = std::move(notice);
    ++notices_;
}

bool Replay::confirms(std::string question) {
    const bool is_again = question == question_ && time_s_ < question_until_s_;
    question_ = is_again ? std::string() : std::move(question);
    question_until_s_ = time_s_ + confirm_within_s;
    return is_again;
}

ReplayMode Replay::mode() const {
    if (clip_ != 0) return list_.playing() ? ReplayMode::list : ReplayMode::clip;
    return transport_.pulse() ? ReplayMode::past : ReplayMode::live;
}

double Replay::speed_of(const PlayEntry& entry) const {
    return entry.speed.value_or(book_->clips.at(entry.clip).speed);
}

double Replay::left_s_of(const PlayEntry& entry) const {
    return book_->clips.at(entry.clip).duration_s(book_->pulse_rate_hz) / speed_of(entry);
}

ReplayState Replay::state() const {
    ReplayState state;
    state.mode = mode();
    state.book = book_;
    state.hand = hand_;
    state.clip = clip_;
    state.selected = list_.selected();
    state.playing = list_.playing();
    state.fast_jog = fast_jog_;
    const TransportState& time = transport_.state();
    state.is_at_programme_speed = plays() && time.speed == book_->programme_speed;
    if (time_s_ < question_until_s_) state.question = question_;
    state.notice = notice_;
    state.notices = notices_;
    if (clip_ == 0 || !time.pulse) return state;
    const double wanted =
        state.playing ? speed_of(list_.entries()[*state.playing]) : book_->clips.at(clip_).speed;
    const double speed = time.speed > 0 ? time.speed : wanted;
    const double out = as_pulse(time.out.value_or(book_->clips.at(clip_).out));
    state.clip_left_s = std::max(0.0, out - *time.pulse) / (speed * book_->pulse_rate_hz);
    // After an overrun the last pulse was shown to its end.
    if (transport_.overrun_s()) state.clip_left_s = 0;
    if (!state.playing) return state;
    state.list_left_s = state.clip_left_s;
    for (std::size_t i = *state.playing + 1; i < list_.entries().size(); ++i)
        *state.list_left_s += left_s_of(list_.entries()[i]);
    return state;
}

void Replay::note_start(bool was_playing) {
    if (plays() && !was_playing)
        last_cue_ = Cue{mode(), *transport_.pulse(), clip_, list_.playing().value_or(0)};
}

void Replay::take(const TransportInput& input, std::uint64_t shown_pulse, const Span& span) {
    if (input.to_pulse || input.at_pulse) leave_piece();
    TransportInput scaled = input;
    scaled.pulses = input.pulses * (fast_jog_ ? fast_jog_factor : 1) + input.shuttle_pulses;
    const bool was_playing = plays();
    transport_.take(scaled, shown_pulse, span);
    note_start(was_playing);
    if (clip_ != 0 && !transport_.pulse()) hold_lost();
    for (const TimeCommand& each : input.commands) {
        if (const auto* transport = std::get_if<TransportCommand>(&each))
            obey_transport(*transport, shown_pulse, span);
        else
            obey(std::get<ReplayCall>(each), shown_pulse, span);
    }
}

void Replay::obey_transport(const TransportCommand& command, std::uint64_t shown_pulse,
                            const Span& span) {
    if (std::holds_alternative<command::ToLive>(command)) leave_piece();
    TransportCommand scaled = command;
    if (auto* step = std::get_if<command::StepFrames>(&scaled))
        step->frames *= fast_jog_ ? fast_jog_factor : 1;
    const bool was_playing = plays();
    transport_.obey(scaled, shown_pulse, span);
    note_start(was_playing);
}

void Replay::obey(const ReplayCall& call, std::uint64_t shown_pulse, const Span& span) {
    switch (call.action) {
        case ReplayAction::last_cue:
            return to_last_cue(span);
        case ReplayAction::programme_speed:
            return toggle_programme_speed(shown_pulse, span);
        case ReplayAction::preset_speed: {
            const bool follows = plays() && transport_.state().speed == book_->programme_speed;
            edit([&](ClipBook& book) { book.programme_speed = call.number / per_cent; });
            if (follows && span) transport_.play(book_->programme_speed, shown_pulse, *span);
            return;
        }
        case ReplayAction::fast_jog:
            fast_jog_ = !fast_jog_;
            return;
        case ReplayAction::make_clip:
        case ReplayAction::trim_clip:
        case ReplayAction::hold_clip:
        case ReplayAction::clip_step:
        case ReplayAction::cue_clip:
        case ReplayAction::play_clip:
        case ReplayAction::clip_speed:
        case ReplayAction::clip_shot:
        case ReplayAction::name_clip:
        case ReplayAction::delete_clip:
            return obey_clip(call, shown_pulse, span);
        case ReplayAction::play_list:
        case ReplayAction::next_entry:
        case ReplayAction::loop_list:
        case ReplayAction::add_entry:
        case ReplayAction::remove_entry:
        case ReplayAction::select_entry:
        case ReplayAction::entry_step:
        case ReplayAction::move_entry:
        case ReplayAction::swap_entry:
        case ReplayAction::entry_speed:
            return obey_list(call, span);
    }
}

Clip* Replay::held_clip(ClipBook& book) const {
    const auto held = book.clips.find(hand_);
    return held == book.clips.end() ? nullptr : &held->second;
}

void Replay::obey_clip(const ReplayCall& call, std::uint64_t shown_pulse, const Span& span) {
    if (call.action == ReplayAction::make_clip) return make_clip(shown_pulse);
    if (call.action == ReplayAction::hold_clip) {
        if (book_->clips.contains(call.number))
            hand_ = call.number;
        else
            notify(fmt::format("there is no clip {}", call.number));
        return;
    }
    if (!book_->clips.contains(hand_))
        return notify("no clip is selected; set both marks and make one");
    switch (call.action) {
        case ReplayAction::trim_clip:
            return trim_clip();
        case ReplayAction::clip_step:
            return step_clip(call.number);
        case ReplayAction::cue_clip:
        case ReplayAction::play_clip:
            (void)begin_clip(call.action == ReplayAction::play_clip, span);
            return;
        case ReplayAction::clip_speed:
            edit([&](ClipBook& book) { held_clip(book)->speed = call.number / per_cent; });
            return follow_speed();
        case ReplayAction::clip_shot:
            edit([&](ClipBook& book) {
                int& shot = held_clip(book)->shot;
                shot = shot == call.number ? 0 : call.number;
            });
            return;
        case ReplayAction::name_clip:
            edit([&](ClipBook& book) { held_clip(book)->name = call.words; });
            return;
        case ReplayAction::delete_clip:
            return delete_clip(span);
        default:
            return;
    }
}

void Replay::obey_list(const ReplayCall& call, const Span& span) {
    switch (call.action) {
        case ReplayAction::add_entry:
            if (!book_->clips.contains(hand_))
                return notify("no clip is selected; select one to add it to the play list");
            if (!list_.insert(hand_))
                return notify(fmt::format("the play list is full with {} entries; remove one first",
                                          most_entries));
            break;
        case ReplayAction::loop_list:
            edit([](ClipBook& book) { book.list_loops = !book.list_loops; });
            return;
        default:
            if (list_.entries().empty())
                return notify("the play list is empty; add the selected clip first");
            switch (call.action) {
                case ReplayAction::play_list:
                    return play_list(span);
                case ReplayAction::next_entry:
                    if (!list_.playing()) return notify("the play list is not playing");
                    if (!enter_entry(list_.next(*list_.playing(), book_->list_loops), span))
                        notify("this is the last entry of the play list");
                    return;
                case ReplayAction::remove_entry:
                    return remove_entry(span);
                case ReplayAction::select_entry:
                case ReplayAction::swap_entry: {
                    const auto place = static_cast<std::size_t>(call.number) - 1;
                    const bool is_there = call.action == ReplayAction::swap_entry
                                              ? list_.swap(place)
                                              : list_.select(place);
                    if (!is_there)
                        return notify(fmt::format(
                            "the play list has only {} entries, so there is no entry {}",
                            list_.entries().size(), call.number));
                    break;
                }
                case ReplayAction::entry_step:
                    list_.select_by(call.number);
                    break;
                case ReplayAction::move_entry:
                    list_.move(call.number);
                    break;
                case ReplayAction::entry_speed:
                    list_.set_speed(call.number / per_cent);
                    break;
                default:
                    return;
            }
    }
    edit([](ClipBook&) {});
    if (call.action == ReplayAction::entry_speed) follow_speed();
}

void Replay::to_last_cue(const Span& span) {
    if (!last_cue_)
        return notify("nothing was played yet, so there is no start of playback to go to");
    const Cue cue = *last_cue_;
    if (!span || cue.pulse < as_pulse(span->oldest))
        return notify("the start of the last playback has left the replay buffer");
    if (cue.mode == ReplayMode::clip || cue.mode == ReplayMode::list) {
        const bool is_of_list = cue.mode == ReplayMode::list;
        // The list may have changed; the entry counts only if it still has the same clip.
        const bool has_entry = is_of_list && cue.entry < list_.entries().size() &&
                               list_.entries()[cue.entry].clip == cue.clip;
        const auto clip = book_->clips.find(cue.clip);
        const double speed = has_entry                    ? speed_of(list_.entries()[cue.entry])
                             : clip != book_->clips.end() ? clip->second.speed
                                                          : 1;
        if (clip != book_->clips.end() && enter_clip(cue.clip, speed, false, span)) {
            if (has_entry)
                list_.play(cue.entry);
            else
                list_.stop();
            transport_.stand_at(cue.pulse, *span);
            return;
        }
    }
    leave_piece();
    transport_.stand_at(cue.pulse, *span);
}

void Replay::toggle_programme_speed(std::uint64_t shown_pulse, const Span& span) {
    if (!span) return notify("there is no past to play");
    const bool was_playing = plays();
    const bool is_at_it = was_playing && transport_.state().speed == book_->programme_speed;
    transport_.play(is_at_it ? 1 : book_->programme_speed, shown_pulse, *span);
    note_start(was_playing);
}

void Replay::make_clip(std::uint64_t shown_pulse) {
    const TransportState& time = transport_.state();
    if (!time.in) return notify("a clip starts at the in mark; set the in mark first");
    const std::uint64_t out = time.out.value_or(
        time.pulse && time.speed == 0 ? static_cast<std::uint64_t>(*time.pulse) : shown_pulse);
    if (out <= *time.in)
        return notify("a clip ends at the out mark; set the out mark after the in mark");
    int number = 1;
    while (book_->clips.contains(number)) ++number;
    if (number > most_clips)
        return notify(
            fmt::format("there are already {} clips, the maximum; delete one first", most_clips));
    Clip clip{.in = *time.in, .out = out};
    if (plays() && time.speed == book_->programme_speed) clip.speed = book_->programme_speed;
    edit([&](ClipBook& book) { book.clips.emplace(number, clip); });
    hand_ = number;
}

void Replay::trim_clip() {
    const TransportState& time = transport_.state();
    if (clip_ != 0 && clip_ != hand_)
        return notify(
            fmt::format("the marks belong to clip {}, but clip {} is selected", clip_, hand_));
    if (!time.in || !time.out)
        return notify("a clip is trimmed to the marks; set both marks first");
    edit([&](ClipBook& book) {
        held_clip(book)->in = *time.in;
        held_clip(book)->out = *time.out;
    });
}

void Replay::step_clip(int by) {
    auto at = book_->clips.find(hand_);
    for (; by > 0 && std::next(at) != book_->clips.end(); --by) ++at;
    for (; by < 0 && at != book_->clips.begin(); ++by) --at;
    hand_ = at->first;
}

void Replay::delete_clip(const Span& span) {
    const int number = hand_;
    const std::string clip = words_of(number, book_->clips.at(number));
    const std::size_t entries = list_.count_of(number);
    std::string what = clip_ == number && plays() ? ", which is playing" : "";
    if (entries > 0) what += ", which is in the play list " + counted_times(entries);
    if (!confirms(fmt::format("give the command again to delete {}{}", clip, what))) return;
    const bool was_playing = list_.remove_clip(number);
    if (clip_ == number && !was_playing) leave_piece();
    const auto next = std::next(book_->clips.find(number));
    hand_ = next != book_->clips.end() ? next->first : 0;
    if (was_playing) replace_playing(span);
    edit([&](ClipBook& book) { book.clips.erase(number); });
    if (hand_ == 0 && !book_->clips.empty()) hand_ = book_->clips.rbegin()->first;
}

bool Replay::enter_clip(int number, double speed, bool plays, const Span& span, double late_s) {
    const Clip& clip = book_->clips.at(number);
    const ClipPresence presence = presence_of(clip, span);
    const char* past = transport_.is_of_take() ? "the take" : "the replay buffer";
    if (presence == ClipPresence::gone) {
        notify(fmt::format("{} is not in {}", words_of(number, clip), past));
        return false;
    }
    if (presence == ClipPresence::part)
        notify(fmt::format("a part of {} is not in {}", words_of(number, clip), past));
    const double rate_hz = book_->pulse_rate_hz, guard = clip.guard_s * rate_hz;
    const double in = as_pulse(clip.in), last = as_pulse(clip.out) - 1;
    transport_.enter({clip.in, clip.out, std::max(0.0, in - guard), last + guard},
                     std::min(in + std::max(0.0, late_s) * speed * rate_hz, last), speed, plays,
                     *span);
    clip_ = number;
    is_list_over_ = false;
    is_loss_reported_ = presence == ClipPresence::part;
    if (clip.shot != 0) shot_ = clip.shot;
    return true;
}

bool Replay::begin_clip(bool plays, const Span& span) {
    if (!enter_clip(hand_, book_->clips.at(hand_).speed, plays, span)) return false;
    list_.stop();
    if (plays) last_cue_ = Cue{ReplayMode::clip, *transport_.pulse(), hand_, 0};
    return true;
}

bool Replay::enter_entry(std::optional<std::size_t> place, const Span& span, double late_s) {
    for (std::size_t tries = 0; place && tries < list_.entries().size(); ++tries) {
        const PlayEntry& entry = list_.entries()[*place];
        if (enter_clip(entry.clip, speed_of(entry), true, span, late_s)) {
            list_.play(*place);
            return true;
        }
        place = list_.next(*place, book_->list_loops);
    }
    return false;
}

void Replay::play_list(const Span& span) {
    if (!enter_entry(list_.selected(), span)) return;
    last_cue_ = Cue{ReplayMode::list, *transport_.pulse(), clip_, *list_.playing()};
}

void Replay::remove_entry(const Span& span) {
    const bool is_playing = list_.playing() && list_.playing() == list_.selected();
    if (is_playing && plays() &&
        !confirms(fmt::format("give the command again to remove entry {}, which is playing",
                              *list_.playing() + 1)))
        return;
    if (list_.remove()) replace_playing(span);
    edit([](ClipBook&) {});
}

void Replay::replace_playing(const Span& span) {
    const std::size_t place = *list_.playing();
    std::optional<std::size_t> next;
    if (place < list_.entries().size())
        next = place;
    else if (book_->list_loops && !list_.entries().empty())
        next = 0;
    if (enter_entry(next, span)) return;
    leave_piece();
    if (span && transport_.pulse()) transport_.stand_at(*transport_.pulse(), *span);
}

void Replay::leave_piece() {
    transport_.leave();
    list_.stop();
    clip_ = 0;
}

void Replay::follow_speed() {
    if (clip_ == 0 || !plays() || !transport_.pulse()) return;
    const double speed = list_.playing() ? speed_of(list_.entries()[*list_.playing()])
                                         : book_->clips.at(clip_).speed;
    transport_.set_speed(speed);
}

void Replay::advance(double dt_s, double pulse_rate_hz, const Span& span) {
    time_s_ += dt_s;
    transport_.advance(dt_s, pulse_rate_hz, span);
    if (clip_ != 0 && span) follow_piece(*span);
}

void Replay::hold_lost() {
    const std::string lost = words_of(clip_, book_->clips.at(clip_));
    leave_piece();
    transport_.hold_what_is_shown();
    notify(fmt::format("{} has left the replay buffer; its last picture is held", lost));
}

void Replay::follow_piece(const PastFrameSets::Span& span) {
    const Clip& clip = book_->clips.at(clip_);
    const bool is_gone = clip.out <= span.oldest;
    const bool is_over = transport_.overrun_s() && list_.playing() && !is_list_over_;
    if (list_.playing() && (is_over || (is_gone && plays()))) {
        const auto next = list_.next(*list_.playing(), book_->list_loops);
        if (enter_entry(next, span, transport_.overrun_s().value_or(0))) return;
        is_list_over_ = true;
    }
    if (is_gone && plays()) return hold_lost();
    if (!is_loss_reported_ && clip.in < span.oldest) {
        is_loss_reported_ = true;
        notify(
            fmt::format("the beginning of {} has left the replay buffer", words_of(clip_, clip)));
    }
}

}  // namespace vantage

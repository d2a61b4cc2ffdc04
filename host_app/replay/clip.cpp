#include "host_app/replay/clip.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "common/config/toml_edit.h"
#include "common/config/toml_reader.h"

namespace vantage {

bool PlayList::select(std::size_t place) {
    if (place >= entries_.size()) return false;
    selected_ = place;
    return true;
}

void PlayList::select_by(int places) {
    if (!selected_) return;
    const auto last = static_cast<std::ptrdiff_t>(entries_.size()) - 1;
    selected_ = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(*selected_) + places, 0, last));
}

bool PlayList::insert(int clip) {
    if (entries_.size() >= most_entries) return false;
    const std::size_t place = selected_ ? *selected_ + 1 : entries_.size();
    entries_.insert(entries_.begin() + static_cast<std::ptrdiff_t>(place), {clip, {}});
    if (playing_ && *playing_ >= place) ++*playing_;
    selected_ = place;
    return true;
}

void PlayList::set_speed(std::optional<double> speed) {
    if (selected_) entries_[*selected_].speed = speed;
}

void PlayList::move(int places) {
    if (!selected_) return;
    const std::size_t from = *selected_;
    select_by(places);
    const std::size_t to = *std::exchange(selected_, from);
    (void)swap(to);
}

bool PlayList::swap(std::size_t place) {
    if (!selected_ || place >= entries_.size()) return false;
    std::swap(entries_[*selected_], entries_[place]);
    if (playing_ == selected_)
        playing_ = place;
    else if (playing_ == place)
        playing_ = selected_;
    selected_ = place;
    return true;
}

bool PlayList::erase(std::size_t place) {
    entries_.erase(entries_.begin() + static_cast<std::ptrdiff_t>(place));
    const bool was_playing = playing_ == place;
    if (playing_ && *playing_ > place) --*playing_;
    if (selected_ && *selected_ > place) --*selected_;
    if (selected_ && *selected_ == entries_.size()) {
        if (entries_.empty())
            selected_.reset();
        else
            --*selected_;
    }
    return was_playing;
}

bool PlayList::remove() { return selected_ && erase(*selected_); }

bool PlayList::remove_clip(int clip) {
    bool was_playing = false;
    for (std::size_t place = entries_.size(); place-- > 0;)
        if (entries_[place].clip == clip) was_playing |= erase(place);
    return was_playing;
}

std::size_t PlayList::count_of(int clip) const {
    return static_cast<std::size_t>(
        std::count_if(entries_.begin(), entries_.end(),
                      [clip](const PlayEntry& entry) { return entry.clip == clip; }));
}

std::optional<std::size_t> PlayList::next(std::size_t after, bool loops) const {
    if (after + 1 < entries_.size()) return after + 1;
    return loops && !entries_.empty() ? std::optional<std::size_t>(0) : std::nullopt;
}

namespace {

constexpr int clip_file_version = 1;
constexpr double min_speed = 0.01, max_speed = 2, max_guard_s = 60;
constexpr int max_shot = 9;

void read_clip(TomlTable& table, ClipBook& book) {
    int number = 0;
    table.require("number");
    table.read("number", number, {1, most_clips});
    Clip clip;
    table.read("name", clip.name);
    if (const std::string fault = fault_of_name(clip.name); !fault.empty())
        table.refuse("name", fault);
    table.require("in_pulse");
    table.read("in_pulse", clip.in);
    table.require("out_pulse");
    table.read("out_pulse", clip.out);
    if (table.has("in_pulse") && table.has("out_pulse") && clip.out <= clip.in)
        table.refuse("out_pulse",
                     "is not after in_pulse; out_pulse is the first pulse that is left out");
    table.read("speed", clip.speed, {min_speed, max_speed});
    table.read("guard_s", clip.guard_s, {0, max_guard_s});
    table.read("shot", clip.shot, {0, max_shot});
    if (number == 0) return;
    if (!book.clips.emplace(number, std::move(clip)).second)
        table.refuse(
            "number",
            fmt::format("is {} for the second time; give every clip its own number", number));
}

void read_entry(TomlTable& table, ClipBook& book) {
    PlayEntry entry;
    table.require("clip");
    table.read("clip", entry.clip, {1, most_clips});
    if (table.has("clip") && !book.clips.contains(entry.clip))
        table.refuse("clip", fmt::format("is {}, but the file has no such clip", entry.clip));
    double speed = 1;
    table.read("speed", speed, {min_speed, max_speed});
    if (table.has("speed")) entry.speed = speed;
    book.list.push_back(entry);
}

}  // namespace

ClipBook load_clips(const std::filesystem::path& path, double pulse_rate_hz) {
    ClipBook book;
    read_toml_file(path, clip_file_version, [&](TomlTable& top) {
        top.require("pulse_rate_hz");
        top.read("pulse_rate_hz", book.pulse_rate_hz, {0.001, 1e6});
        constexpr double same_rate = 1e-6;
        if (top.has("pulse_rate_hz") &&
            std::abs(book.pulse_rate_hz / pulse_rate_hz - 1) > same_rate)
            top.refuse("pulse_rate_hz",
                       fmt::format("is {}, but the stage or take has {} pulses per second, so its "
                                   "clips would be at other times; name another file with --clips",
                                   book.pulse_rate_hz, pulse_rate_hz));
        book.pulse_rate_hz = pulse_rate_hz;
        top.read("programme_speed", book.programme_speed, {min_speed, max_speed});
        top.read("list_loops", book.list_loops);
        top.read_tables("clip", [&](TomlTable& table) { read_clip(table, book); });
        top.read_tables("entry", [&](TomlTable& table) { read_entry(table, book); });
        if (book.list.size() > most_entries)
            top.refuse("entry",
                       fmt::format("occurs {} times, and a play list has at most {} entries",
                                   book.list.size(), most_entries));
    });
    return book;
}

std::string to_toml(const ClipBook& book) {
    std::string text = fmt::format(
        "# Clips and play list of Vantage; docs/reference/formats.md explains the keys.\nversion = "
        "{}\n"
        "pulse_rate_hz = {}\nprogramme_speed = {}\nlist_loops = {}\n",
        clip_file_version, book.pulse_rate_hz, book.programme_speed, book.list_loops);
    for (const auto& [number, clip] : book.clips)
        text += fmt::format(
            "\n[[clip]]\nnumber = {}\nname = {}\nin_pulse = {}\nout_pulse = {}\nspeed = {}\n"
            "guard_s = {}\nshot = {}\n",
            number, toml_string(clip.name), clip.in, clip.out, clip.speed, clip.guard_s, clip.shot);
    for (const PlayEntry& entry : book.list) {
        text += fmt::format("\n[[entry]]\nclip = {}\n", entry.clip);
        if (entry.speed) text += fmt::format("speed = {}\n", *entry.speed);
    }
    return text;
}

ClipStore::ClipStore(std::filesystem::path file, double pulse_rate_hz)
    : file_(std::move(file), "clips and play list") {
    ClipBook book;
    book.pulse_rate_hz = pulse_rate_hz;
    if (file_.is_there()) book = load_clips(file_.path(), pulse_rate_hz);
    book_ = std::make_shared<const ClipBook>(std::move(book));
}

void ClipStore::follow(const std::shared_ptr<const ClipBook>& book, MonotonicTime now) {
    if (book && book != book_) {
        if (*book != *book_) file_.note_change();
        book_ = book;
    }
    if (file_.is_due(now)) (void)file_.write(to_toml(*book_));
}

void ClipStore::finish() {
    if (file_.is_changed()) (void)file_.write(to_toml(*book_));
}

std::filesystem::path clip_file_of(std::filesystem::path file) {
    return file.replace_extension(".clips.toml");
}

}  // namespace vantage

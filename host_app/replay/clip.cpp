#include "host_app/replay/clip.h"

#include <algorithm>
#include <utility>

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

}  // namespace vantage

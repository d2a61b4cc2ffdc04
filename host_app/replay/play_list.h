#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "host_app/replay/clip.h"

namespace vantage {

/// The play list: clips in the order in which they play. Edits apply to the selected entry and do
/// not interrupt the entry that is playing. Places count from 0.
class PlayList {
  public:
    PlayList() = default;
    explicit PlayList(std::vector<PlayEntry> entries) : entries_(std::move(entries)) {
        if (!entries_.empty()) selected_ = 0;
    }

    const std::vector<PlayEntry>& entries() const { return entries_; }
    /// Empty: there is no entry, or none is playing.
    std::optional<std::size_t> selected() const { return selected_; }
    std::optional<std::size_t> playing() const { return playing_; }

    /// False if there is no such place.
    bool select(std::size_t place);
    /// Moves the selection down (positive) or up, to the ends at most.
    void select_by(int places);
    /// Inserts a clip after the selected entry and selects it. False if the list is full.
    bool insert(int clip);
    void set_speed(std::optional<double> speed);
    /// Swaps the selected entry with one further down or up; it stays selected.
    void move(int places);
    /// Swaps the selected entry with the one at `place`; it stays selected. False if there is none.
    bool swap(std::size_t place);
    /// Removes the selected entry and selects the next one. True if the entry was playing; then the
    /// one that takes its place, if any, is to play.
    bool remove();
    /// Removes all entries of a clip. True if the one that is playing was among them.
    bool remove_clip(int clip);
    std::size_t count_of(int clip) const;

    void play(std::size_t place) { playing_ = place; }
    void stop() { playing_.reset(); }
    /// The place after `after`; empty at the end of a list that does not loop.
    std::optional<std::size_t> next(std::size_t after, bool loops) const;

  private:
    bool erase(std::size_t place);

    std::vector<PlayEntry> entries_;
    std::optional<std::size_t> selected_, playing_;
};

}  // namespace vantage

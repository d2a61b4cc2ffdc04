#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "host_app/replay/clip.h"

namespace vantage {

/// The order in which clips are played, which may be changed while it is: what plays plays on.
/// Edits are of the entry that is selected.
class PlayList {
  public:
    PlayList() = default;
    explicit PlayList(std::vector<PlayEntry> entries) : entries_(std::move(entries)) {
        if (!entries_.empty()) selected_ = 0;
    }

    const std::vector<PlayEntry>& entries() const { return entries_; }
    /// Places from 0 on; nothing: there is no entry, or none plays.
    std::optional<std::size_t> selected() const { return selected_; }
    std::optional<std::size_t> playing() const { return playing_; }

    /// False: there is no such place.
    bool select(std::size_t place);
    /// Further down, or up, as far as the ends.
    void select_by(int places);
    /// Behind the selected entry, and is selected then. False: the list is full.
    bool insert(int clip);
    void set_speed(std::optional<double> speed);
    /// By one place down or up; at the ends it stays.
    void move(int places);
    /// The selected entry and the one at `place`, each where the other was; it stays
    /// selected. False: there is none.
    bool swap(std::size_t place);
    /// The selected entry; the next one is selected then. True: it was the one that plays, and the
    /// one that stands there now, if any, should.
    bool remove();
    /// All entries of a clip. True: the one that plays was among them.
    bool remove_clip(int clip);
    std::size_t count_of(int clip) const;

    void play(std::size_t place) { playing_ = place; }
    void stop() { playing_.reset(); }
    /// Behind the one that plays; nothing: that is the last, and it does not loop.
    std::optional<std::size_t> next(std::size_t after, bool loops) const;

  private:
    bool erase(std::size_t place);

    std::vector<PlayEntry> entries_;
    std::optional<std::size_t> selected_, playing_;
};

}  // namespace vantage

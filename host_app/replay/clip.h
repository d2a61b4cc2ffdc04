#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/files/kept_file.h"
#include "host_app/frames/past_frame_sets.h"

namespace vantage {

constexpr int most_clips = 99;
constexpr std::size_t most_entries = 200;

/// A named part of the past. It is given by pulse indices, which stay valid in the replay buffer,
/// in a take, and in later sessions.
struct Clip {
    std::string name = {};          ///< may be empty
    std::uint64_t in = 0, out = 0;  ///< `out` is the first pulse that is left out
    double speed = 1;               ///< of playback; 1 is normal
    double guard_s = 2;             ///< time before and after the clip that the operator can reach
    int shot = 0;                   ///< the camera flies to this shot when it starts; 0: none

    double duration_s(double pulse_rate_hz) const {
        return static_cast<double>(out - in) / pulse_rate_hz;
    }
    bool operator==(const Clip&) const = default;
};

/// An entry of the play list.
struct PlayEntry {
    int clip = 1;                      ///< number of the clip
    std::optional<double> speed = {};  ///< replaces the speed of the clip
    bool operator==(const PlayEntry&) const = default;
};

/// Contents of a clip file.
struct ClipBook {
    double pulse_rate_hz = 30;
    double programme_speed = 0.5;  ///< of slow motion, as one key gives it
    std::map<int, Clip> clips;     ///< by number, 1 to most_clips
    std::vector<PlayEntry> list;   ///< all of its clips exist
    bool list_loops = false;
    bool operator==(const ClipBook&) const = default;
};

/// Part of a clip that the past still has.
enum class ClipPresence { whole, part, gone };
inline ClipPresence presence_of(const Clip& clip, const std::optional<PastFrameSets::Span>& span) {
    if (!span || clip.out <= span->oldest || clip.in > span->newest) return ClipPresence::gone;
    const bool is_whole = clip.in >= span->oldest && clip.out <= span->newest + 1;
    return is_whole ? ClipPresence::whole : ClipPresence::part;
}

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

/// Reads a clip file (docs/reference/formats.md shows every key). Throws Error with file and line
/// if a value does not fit, and if the file has another pulse rate.
ClipBook load_clips(const std::filesystem::path& path, double pulse_rate_hz);

/// The text of a clip file, which load_clips() reads back.
std::string to_toml(const ClipBook& book);

/// Keeps the clips and the play list of a show in a clip file beside the stage file or the take;
/// see KeptFile for when it is written and which file it replaces. Used on the session's thread
/// only.
class ClipStore {
  public:
    /// Reads the file if it exists. Throws Error as load_clips() does.
    ClipStore(std::filesystem::path file, double pulse_rate_hz);

    /// The book to start the session with.
    const ClipBook& book() const { return *book_; }
    /// Takes over the present book and writes changes that are due; to be called often.
    void follow(const std::shared_ptr<const ClipBook>& book, MonotonicTime now);
    /// Writes all changes.
    void finish();

  private:
    KeptFile file_;
    std::shared_ptr<const ClipBook> book_;
};

/// Name of the clip file: STAGE.clips.toml for STAGE.toml, TAKE.clips.toml for TAKE.mkv.
std::filesystem::path clip_file_of(std::filesystem::path file);

}  // namespace vantage

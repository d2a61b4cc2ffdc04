#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

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

}  // namespace vantage

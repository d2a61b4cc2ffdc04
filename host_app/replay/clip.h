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

/// A part of what was filmed, by the pulses themselves: it means the same in the replay buffer, in
/// a take, and tomorrow.
struct Clip {
    std::string name = {};          ///< empty: nobody has given it one
    std::uint64_t in = 0, out = 0;  ///< `out` is the first that is left out
    double speed = 1;               ///< that it is played at; 1 is as it was
    double guard_s = 2;             ///< before and after it that hands can go to
    int shot = 0;                   ///< that the camera flies to with it; 0: none

    double duration_s(double pulse_rate_hz) const {
        return static_cast<double>(out - in) / pulse_rate_hz;
    }
    bool operator==(const Clip&) const = default;
};

/// A place in the play list.
struct PlayEntry {
    int clip = 1;                      ///< its number
    std::optional<double> speed = {};  ///< instead of the clip's
    bool operator==(const PlayEntry&) const = default;
};

/// What is kept of a show's replay.
struct ClipBook {
    double pulse_rate_hz = 30;
    double programme_speed = 0.5;  ///< the slow motion that a key gives
    std::map<int, Clip> clips;     ///< by number, 1 to most_clips
    std::vector<PlayEntry> list;   ///< every clip that it names is there
    bool list_loops = false;
    bool operator==(const ClipBook&) const = default;
};

/// How much of a clip there is to be played.
enum class ClipPresence { whole, part, gone };
ClipPresence presence_of(const Clip& clip, const std::optional<PastFrameSets::Span>& span);

}  // namespace vantage

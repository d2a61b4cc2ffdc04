#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/take/take_reader.h"

namespace vantage {

/// A range of pulses without a frame of a rig.
struct TakeGap {
    std::string rig;
    std::uint64_t from = 0, to = 0;  ///< first and last pulse
    std::string why;                 ///< by the counters of the frames around it; may be empty
    std::uint64_t pulses() const { return to - from + 1; }
};

/// The gaps between a rig's frames, which are in the order of their pulses. Counters tell how many
/// pulses were lost and why, but not which: a rig counts losses while earlier frames are still
/// being packed, and a link drops packed frames out of order. So each counted loss is assigned once
/// to a gap nearby.
std::vector<TakeGap> gaps_between(const std::string& rig,
                                  std::span<const TakeReader::Frame> frames);

/// A time without sound.
struct SoundGap {
    TaiTime from{};
    double seconds = 0;
};

struct TakeVerdict {
    std::vector<TakeGap> gaps;
    std::vector<SoundGap> sound_gaps;
    std::vector<TakeDamage> damage;
    std::uint64_t frames = 0;  ///< undamaged
    double sound_s = 0;        ///< undamaged
    bool is_whole() const { return gaps.empty() && sound_gaps.empty() && damage.empty(); }
};

/// Reads and checks every byte of a take. A rig or sound that begins or ends within a second of the
/// take has no gap there, since frames arrive with the network's delay. `progress` gets 0..1 now
/// and then.
TakeVerdict check_take(const TakeReader& take, const std::function<void(double)>& progress = {});

}  // namespace vantage

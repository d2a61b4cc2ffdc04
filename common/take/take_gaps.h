#pragma once

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

}  // namespace vantage

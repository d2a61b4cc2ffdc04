#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/take/take_reader.h"

namespace vantage {

/// Pulses that a rig is not in.
struct TakeGap {
    std::string rig;
    std::uint64_t from = 0, to = 0;  ///< the first and the last of them
    std::string why;                 ///< as the counters of the frames around it say; may be empty
    std::uint64_t pulses() const { return to - from + 1; }
};

/// Between a rig's frames, which are in the order of their pulses. Counters tell how many pulses
/// were lost and why, though not which: a rig counts while earlier frames are still on their way to
/// be packed, and a link drops frames that were packed before others. So what is counted is dealt
/// out, every loss once, to the gaps around.
std::vector<TakeGap> gaps_between(const std::string& rig,
                                  std::span<const TakeReader::Frame> frames);

}  // namespace vantage

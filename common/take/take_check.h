#pragma once

#include <functional>
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

struct TakeVerdict {
    std::vector<TakeGap> gaps;
    std::vector<TakeDamage> damage;
    std::uint64_t frames = 0;  ///< that are whole
    bool is_whole() const { return gaps.empty() && damage.empty(); }
};

/// Looks at every byte of every frame. A rig that begins or ends within a second of the take has no
/// gap there: frames come when the network brings them. `progress`: 0..1, now and then.
TakeVerdict check_take(const TakeReader& take, const std::function<void(double)>& progress = {});

}  // namespace vantage

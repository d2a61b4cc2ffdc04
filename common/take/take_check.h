#pragma once

#include <functional>
#include <vector>

#include "common/take/take_gaps.h"

namespace vantage {

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

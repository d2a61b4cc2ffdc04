#pragma once

#include <functional>
#include <vector>

#include "common/take/take_gaps.h"

namespace vantage {

/// Time that the sound lacks.
struct SoundGap {
    TaiTime from{};
    double seconds = 0;
};

struct TakeVerdict {
    std::vector<TakeGap> gaps;
    std::vector<SoundGap> sound_gaps;
    std::vector<TakeDamage> damage;
    std::uint64_t frames = 0;  ///< that are whole
    double sound_s = 0;        ///< that is whole
    bool is_whole() const { return gaps.empty() && sound_gaps.empty() && damage.empty(); }
};

/// Looks at every byte of every frame. A rig that begins or ends within a second of the take has no
/// gap there, and so it is with sound: frames come when the network brings them. `progress`: 0..1,
/// now and then.
TakeVerdict check_take(const TakeReader& take, const std::function<void(double)>& progress = {});

}  // namespace vantage

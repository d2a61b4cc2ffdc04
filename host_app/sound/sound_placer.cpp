#include "host_app/sound/sound_placer.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

/// An offset that clock drift cannot explain: samples were lost, or the device runs at full speed.
constexpr std::int64_t break_samples = sound_rate_hz / 4;
/// The average offset at which drift is corrected, over two seconds.
constexpr double mended_samples = sound_rate_hz / 1000.0;
constexpr double average_samples = 2.0 * sound_rate_hz;
/// At most 1 / mend_share of a block is inserted or removed.
constexpr std::int64_t mend_share = 400;

}  // namespace

SoundBlock SoundPlacer::place(std::span<const float> block, TaiTime heard_until) {
    const auto count = static_cast<std::int64_t>(block.size() / sound_channels);
    const std::int64_t end = sound_sample_at(heard_until);
    if (!next_) next_ = end - count;
    stats_.heard += static_cast<std::uint64_t>(count);
    const std::int64_t late = end - (*next_ + count);
    if (late < -break_samples) {
        stats_.dropped += static_cast<std::uint64_t>(count);
        return {*next_, {}};
    }
    if (late > break_samples) {
        stats_.lost += static_cast<std::uint64_t>(late);
        *next_ += late;
        late_ = 0;
    } else {
        late_ += (static_cast<double>(late) - late_) *
                 std::min(1.0, static_cast<double>(count) / average_samples);
    }
    std::int64_t mend = 0;
    if (std::abs(late_) > mended_samples) {
        mend = late_ > 0 ? 1 + count / mend_share : -1 - count / mend_share;
        late_ -= static_cast<double>(mend);
        (mend > 0 ? stats_.inserted : stats_.removed) += static_cast<std::uint64_t>(std::abs(mend));
    }
    SoundBlock placed{
        *next_,
        stretched(block, static_cast<std::size_t>(std::max<std::int64_t>(0, count + mend)))};
    *next_ = placed.end();
    return placed;
}

}  // namespace vantage

#include "common/receive/take_starter.h"

#include <algorithm>

namespace vantage {

std::optional<std::uint64_t> TakeStarter::update(const std::vector<Rig>& rigs, TaiTime tai,
                                                 MonotonicTime now) {
    if (first_pulse_) return first_pulse_;
    for (const Rig& rig : rigs)
        if (rig.connected && rig.sync.first_pulse != 0) {
            first_pulse_ = rig.sync.first_pulse;
            return first_pulse_;
        }
    const auto is_ready = [](const Rig& rig) { return rig.connected && rig.sync.ready; };
    if (std::none_of(rigs.begin(), rigs.end(), is_ready)) {
        first_ready_.reset();
        return std::nullopt;
    }
    if (!first_ready_) first_ready_ = now;
    const bool all_ready = std::all_of(rigs.begin(), rigs.end(), is_ready);
    if (all_ready || now - *first_ready_ >= longest_wait)
        first_pulse_ = grid_.index_at_or_before(tai + notice) + 1;
    return first_pulse_;
}

}  // namespace vantage

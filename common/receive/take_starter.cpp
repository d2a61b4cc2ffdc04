#include "common/receive/take_starter.h"

#include <algorithm>

namespace vantage {
namespace {

bool is_ready(const TakeStarter::Rig& rig) { return rig.connected && rig.sync.ready; }

}  // namespace

std::optional<std::uint64_t> TakeStarter::update(const std::vector<Rig>& rigs, TaiTime tai,
                                                 MonotonicTime now) {
    if (first_pulse_) return first_pulse_;
    first_pulse_ = find_first_pulse(rigs, tai, now);
    if (first_pulse_) name_laggards_at_ = now + ready_patience;
    return first_pulse_;
}

std::vector<std::size_t> TakeStarter::laggards(const std::vector<Rig>& rigs, MonotonicTime now) {
    std::vector<std::size_t> found;
    if (!name_laggards_at_ || now < *name_laggards_at_) return found;
    name_laggards_at_.reset();
    for (std::size_t i = 0; i < rigs.size(); ++i)
        if (!is_ready(rigs[i])) found.push_back(i);
    return found;
}

std::optional<std::uint64_t> TakeStarter::find_first_pulse(const std::vector<Rig>& rigs,
                                                           TaiTime tai, MonotonicTime now) {
    for (const Rig& rig : rigs)
        if (rig.connected && rig.sync.first_pulse != 0 &&
            rig.sync.first_pulse <= grid_.index_at_or_before(tai + latest_start))
            return rig.sync.first_pulse;
    if (std::none_of(rigs.begin(), rigs.end(), is_ready)) {
        first_ready_.reset();
        return std::nullopt;
    }
    if (!first_ready_) first_ready_ = now;
    const bool all_ready = std::all_of(rigs.begin(), rigs.end(), is_ready);
    if (!all_ready && now - *first_ready_ < longest_wait) return std::nullopt;
    return grid_.index_at_or_before(tai + notice) + 1;
}

}  // namespace vantage

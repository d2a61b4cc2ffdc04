#include "common/base/time/pulse_grid.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace vantage {
namespace {

__extension__ using Wide = __int128;

}  // namespace

PulseGrid::PulseGrid(double rate_hz) {
    assert(rate_hz >= 0.001 && rate_hz <= 1e6);
    const double nominal = rate_hz * 1.001;
    const bool is_whole = rate_hz == std::round(rate_hz);
    if (!is_whole && std::abs(nominal - std::round(nominal)) < 0.001) {
        pulses_ = std::llround(nominal) * 1000;
        seconds_ = 1001;
    } else {
        pulses_ = std::llround(rate_hz * 1000);
        seconds_ = 1000;
    }
}

TaiTime PulseGrid::time_of(std::uint64_t index) const {
    const Wide ns = static_cast<Wide>(index) * seconds_ * nanoseconds_per_second / pulses_;
    constexpr Wide last_ns = std::numeric_limits<std::int64_t>::max();
    return tai_from_ns(static_cast<std::int64_t>(std::min(ns, last_ns)));
}

std::uint64_t PulseGrid::index_at_or_before(TaiTime time) const {
    const Wide index = static_cast<Wide>(to_ns(time)) * pulses_ / seconds_ / nanoseconds_per_second;
    // The time of a pulse is rounded down to a nanosecond and may precede its exact time.
    const auto next = static_cast<std::uint64_t>(index) + 1;
    return time_of(next) <= time ? next : next - 1;
}

std::uint64_t PulseGrid::nearest_index(TaiTime time) const {
    return index_at_or_before(time + period() / 2);
}

std::chrono::nanoseconds PulseGrid::period() const {
    return std::chrono::nanoseconds(
        static_cast<std::int64_t>(static_cast<Wide>(seconds_) * nanoseconds_per_second / pulses_));
}

double PulseGrid::rate_hz() const {
    return static_cast<double>(pulses_) / static_cast<double>(seconds_);
}

PulseGrid::Fraction PulseGrid::rate() const {
    const std::int64_t common = std::gcd(pulses_, seconds_);
    return {pulses_ / common, seconds_ / common};
}

}  // namespace vantage

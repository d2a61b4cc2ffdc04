#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace vantage {

/// The pulses from `from` to before `to`.
struct PulseRange {
    std::uint64_t from = 0, to = 0;
    std::uint64_t pulses() const { return to > from ? to - from : 0; }
    bool operator==(const PulseRange&) const = default;
};

/// The parts of `whole` without the pulses `there`, which are sorted.
std::vector<PulseRange> missing_parts(PulseRange whole, std::span<const std::uint64_t> there);

}  // namespace vantage

#pragma once

#include <cassert>
#include <cstdint>
#include <span>

namespace vantage {

/// Readers of little-endian numbers in a report. Precondition of all: the report is long enough.
inline std::int8_t int8_at(std::span<const std::uint8_t> report, std::size_t at) {
    assert(at < report.size());
    return static_cast<std::int8_t>(report[at]);
}
inline std::uint16_t uint16_at(std::span<const std::uint8_t> report, std::size_t at) {
    assert(at + 1 < report.size());
    return static_cast<std::uint16_t>(report[at] | report[at + 1] << 8);
}
inline std::int16_t int16_at(std::span<const std::uint8_t> report, std::size_t at) {
    return static_cast<std::int16_t>(uint16_at(report, at));
}
/// Reads `bytes` bytes, at most eight.
inline std::uint64_t uint_at(std::span<const std::uint8_t> report, std::size_t at,
                             std::size_t bytes) {
    assert(bytes <= 8 && at + bytes <= report.size());
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i)
        value |= static_cast<std::uint64_t>(report[at + i]) << (8 * i);
    return value;
}

}  // namespace vantage

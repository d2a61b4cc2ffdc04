#pragma once

#include <bit>
#include <cassert>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "host_app/control/hid/jog_family.h"

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

/// Converts masks of held buttons into events for the buttons that changed.
class HeldButtons {
  public:
    /// `name_of` returns the name of a bit's button; an empty name means no button.
    void update(std::uint64_t mask, const std::function<std::string(int bit)>& name_of,
                std::vector<JogEvent>& events) {
        for (std::uint64_t changed = mask ^ held_; changed != 0; changed &= changed - 1) {
            const int bit = std::countr_zero(changed);
            std::string name = name_of(bit);
            if (!name.empty())
                events.push_back({JogKind::button, std::move(name), (mask >> bit & 1) ? 1.0 : 0.0});
        }
        held_ = mask;
    }

  private:
    std::uint64_t held_ = 0;
};

/// Remembers axis positions and creates events only for axes that moved, since some devices repeat
/// themselves.
class AxisPosition {
  public:
    void update(double value, const std::string& name, std::vector<JogEvent>& events) {
        if (value != value_) events.push_back({JogKind::axis, name, value});
        value_ = value;
    }

  private:
    double value_ = 0;
};

}  // namespace vantage

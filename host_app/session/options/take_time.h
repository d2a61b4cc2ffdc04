#pragma once

#include <cstdint>
#include <string>

#include "common/take/take_reader.h"

namespace vantage {

/// The pulse that a person names by its time in a take of pulses `first` to `last`: "12.5", seconds
/// after its beginning, or "10:00:12:05", the house's time code in this process's zone (see
/// TimeLabel). May be the one after `last`. Throws Error if the words are neither, or the code does
/// not exist or is not in the take.
std::uint64_t pulse_of(const TakeReader& take, const std::string& text, std::uint64_t first,
                       std::uint64_t last);

}  // namespace vantage

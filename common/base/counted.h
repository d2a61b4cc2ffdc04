#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace vantage {

/// A count with its noun, whose plural ends in s: "1 corner", "2 corners".
inline std::string counted(std::size_t count, std::string_view noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// "once", "2 times".
inline std::string counted_times(std::size_t count) {
    return count == 1 ? std::string("once") : fmt::format("{} times", count);
}

}  // namespace vantage

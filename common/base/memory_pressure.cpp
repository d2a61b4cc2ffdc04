#include "common/base/memory_pressure.h"

#include <cstdio>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

namespace vantage {

std::optional<double> memory_pressure() {
    std::ifstream file("/proc/pressure/memory");
    return parse_memory_pressure({std::istreambuf_iterator<char>(file), {}});
}

std::optional<double> parse_memory_pressure(const std::string& text) {
    double percent = 0;
    // The first line is of the time in which at least one program waited.
    if (std::sscanf(text.c_str(), "some avg10=%lf", &percent) != 1) return std::nullopt;
    return percent / 100;
}

std::string memory_worry(std::optional<double> pressure) {
    // A tick of 25 Hz is missed from a few per cent on.
    constexpr double noticeable = 0.05;
    if (pressure.value_or(0) < noticeable) return "";
    return fmt::format(
        "this computer is short of memory: programs waited for it in {:.0f} % of the last 10 s",
        100 * *pressure);
}

}  // namespace vantage

#pragma once

#include <optional>
#include <string>

namespace vantage {

/// The share of the last ten seconds in which a program of this computer waited for memory, from 0
/// to 1 (the kernel's pressure stall information). Empty: the kernel does not say.
std::optional<double> memory_pressure();

/// The same of the text of /proc/pressure/memory.
std::optional<double> parse_memory_pressure(const std::string& text);

/// One sentence if programs wait for memory so long that a show suffers; empty otherwise.
std::string memory_worry(std::optional<double> pressure);

}  // namespace vantage

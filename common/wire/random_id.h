#pragma once

#include <cstdint>

namespace vantage {

/// A random number from the system, never 0.
std::uint64_t random_id();

}  // namespace vantage

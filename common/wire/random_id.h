#pragma once

#include <cstdint>

namespace vantage {

/// Never 0; from the system's entropy.
std::uint64_t random_id();

}  // namespace vantage

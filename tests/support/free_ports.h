#pragma once

#include <utility>

namespace vantage {

/// Two ports of loopback that nobody listens on.
std::pair<int, int> two_free_ports();

}  // namespace vantage

#pragma once

#include <utility>

namespace vantage {

/// Two ports of loopback that nobody listens on, and that the system gives to nobody else as long
/// as this process lives: who asks for one of them by its number can listen there.
std::pair<int, int> two_free_ports();

}  // namespace vantage

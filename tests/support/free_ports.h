#pragma once

#include <utility>

namespace vantage {

/// Two loopback ports without listeners, reserved while this process lives: the system gives them
/// to no other program, but a program that asks for their number can listen there.
std::pair<int, int> two_free_ports();

}  // namespace vantage

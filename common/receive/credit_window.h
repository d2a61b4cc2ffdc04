#pragma once

#include <chrono>
#include <cstdint>

namespace vantage {

/// Number of frames that may be on the way to this host or wait to be decoded: a few, and as many
/// as the rig sends until it hears that one was handled.
///
/// `round_trip` is that of the connection over TCP, which carries the credit. On a road of
/// datagrams frames do not stop while TCP repeats a lost credit, so the window covers a second of
/// that, too. `rate_hz` is the rig's; 0: unknown.
std::uint32_t credit_window(std::chrono::microseconds round_trip, double rate_hz,
                            bool by_datagrams);

}  // namespace vantage

#include "common/receive/credit_window.h"

#include <algorithm>
#include <cmath>

#include "common/wire/limits.h"

namespace vantage {
namespace {

/// Frames that may wait to be decoded.
constexpr double waiting_frames = 4;
constexpr double highest_usual_rate_hz = 60;
/// Until Linux repeats a packet, beyond the round trip.
constexpr double repeat_s = 0.2;

}  // namespace

std::uint32_t credit_window(std::chrono::microseconds round_trip, double rate_hz,
                            bool by_datagrams) {
    const double rate = rate_hz > 0 ? rate_hz : highest_usual_rate_hz;
    const double round_trip_s = std::chrono::duration<double>(round_trip).count();
    // A repeated credit takes a second round trip, and so do a frame's repeated packets.
    const double way_s = by_datagrams ? repeat_s + 3 * round_trip_s : round_trip_s;
    const double frames = waiting_frames + std::round(way_s * rate);
    return static_cast<std::uint32_t>(
        std::clamp<double>(frames, waiting_frames, max_credit_window));
}

}  // namespace vantage

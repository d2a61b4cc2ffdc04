#include "common/receive/credit_window.h"

#include <algorithm>
#include <cmath>

#include "common/wire/limits.h"

namespace vantage {
namespace {

/// Frames that may wait to be decoded.
constexpr double waiting_frames = 4;
constexpr double highest_usual_rate_hz = 60;
/// How long TCP stands still where a credit and its repetition get lost.
constexpr double standstill_s = 1;

}  // namespace

std::uint32_t credit_window(std::chrono::microseconds round_trip, double rate_hz,
                            bool by_datagrams) {
    const double rate = rate_hz > 0 ? rate_hz : highest_usual_rate_hz;
    const double round_trip_s = std::chrono::duration<double>(round_trip).count();
    const double way_s = round_trip_s + (by_datagrams ? standstill_s : 0);
    const double frames = waiting_frames + std::round(way_s * rate);
    return static_cast<std::uint32_t>(std::clamp<double>(
        frames, waiting_frames, by_datagrams ? max_datagram_credit_window : max_credit_window));
}

}  // namespace vantage

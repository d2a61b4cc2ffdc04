#pragma once

#include <chrono>
#include <string>

#include "common/config/rig_config.h"

namespace vantage {

/// Timing of a triggered sensor. It exposes from the pulse's leading edge for the pulse's width
/// plus `exposure_offset`, then reads out. A pulse during either is lost or spoils the frame, so
/// that both have to fit into one period.
struct SensorTiming {
    std::chrono::nanoseconds exposure{};
    std::chrono::nanoseconds exposure_offset{};
    std::chrono::nanoseconds readout{};
    std::chrono::nanoseconds timestamp_delay{};  ///< from the pulse to the driver's time stamp

    std::chrono::nanoseconds pulse_width() const { return exposure - exposure_offset; }
    std::chrono::nanoseconds exposure_centre() const { return exposure / 2; }
};

/// Returns the configured timing, with the model's own values where the configuration gives none.
/// Throws Error for an unknown model, for an exposure that the sensor cannot be pulsed for, and,
/// with the numbers, for exposure and readout that do not fit into a period of `rate_hz`.
SensorTiming sensor_timing(const RigConfig::Trigger& trigger, double rate_hz);

}  // namespace vantage

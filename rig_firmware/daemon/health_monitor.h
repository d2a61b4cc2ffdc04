#pragma once

#include <deque>
#include <filesystem>
#include <optional>

#include "common/base/time/time.h"
#include "common/wire/link_message.h"

namespace vantage {

/// The hottest of the computer's thermal zones in degrees Celsius; empty where it has none. `sys`
/// is where sysfs is mounted.
std::optional<float> hottest_zone_c(const std::filesystem::path& sys = "/sys");

/// Whether a supply alarm of the kernel's hardware monitors is on, as a Raspberry Pi raises it when
/// its voltage sags.
bool has_under_voltage(const std::filesystem::path& sys = "/sys");

/// Puts together what a rig tells hosts of its own state. Not thread-safe.
class HealthMonitor {
  public:
    /// `calibration`: the facts that do not change.
    explicit HealthMonitor(RigHealth calibration, std::filesystem::path sys = "/sys");

    /// The state now, with the rates over the last five seconds of looks. To be asked about once a
    /// second: it reads files.
    RigHealth look(const RigCounters& counters, MonotonicTime now);

  private:
    struct Sample {
        MonotonicTime time;
        std::uint64_t captured, published;
    };
    RigHealth facts_;
    std::filesystem::path sys_;
    std::deque<Sample> samples_;
};

}  // namespace vantage

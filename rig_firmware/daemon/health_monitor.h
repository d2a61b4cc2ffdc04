#pragma once

#include <deque>
#include <filesystem>
#include <optional>

#include "common/base/time/time.h"
#include "common/wire/link_message.h"

namespace vantage {

/// Temperature of the computer's hottest thermal zone in degrees Celsius; empty if it has none.
/// `sys` is the mount point of sysfs.
std::optional<float> hottest_zone_c(const std::filesystem::path& sys = "/sys");

/// True while one of the kernel's hardware monitors reports under-voltage. A Raspberry Pi raises
/// this alarm when its supply sags.
bool has_under_voltage(const std::filesystem::path& sys = "/sys");

/// Collects the health report that a rig sends to hosts. Not thread-safe.
class HealthMonitor {
  public:
    /// `calibration`: the part of the report that never changes.
    explicit HealthMonitor(RigHealth calibration, std::filesystem::path sys = "/sys");

    /// Returns the current health with the rates of the last five seconds. It reads files; call it
    /// once a second.
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

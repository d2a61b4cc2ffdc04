#include "rig_firmware/daemon/health_monitor.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace vantage {
namespace {

constexpr std::chrono::seconds rate_window(5);

std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> entries;
    std::error_code absent;
    for (const auto& entry : std::filesystem::directory_iterator(folder, absent))
        entries.push_back(entry.path());
    return entries;
}

/// Reads an integer from a file of sysfs; empty if the file is missing or cannot be read.
std::optional<long> number_in(const std::filesystem::path& file) {
    std::ifstream stream(file);
    long number = 0;
    if (!(stream >> number)) return std::nullopt;
    return number;
}

}  // namespace

std::optional<float> hottest_zone_c(const std::filesystem::path& sys) {
    constexpr float per_millidegree = 1e-3f;
    std::optional<float> hottest;
    for (const auto& zone : entries_of(sys / "class/thermal"))
        if (const std::optional<long> reading = number_in(zone / "temp"))
            hottest =
                std::max(hottest.value_or(-1e9f), static_cast<float>(*reading) * per_millidegree);
    return hottest;
}

bool has_under_voltage(const std::filesystem::path& sys) {
    const auto monitors = entries_of(sys / "class/hwmon");
    return std::any_of(monitors.begin(), monitors.end(), [](const auto& monitor) {
        return number_in(monitor / "in0_lcrit_alarm").value_or(0) != 0;
    });
}

HealthMonitor::HealthMonitor(RigHealth calibration, std::filesystem::path sys)
    : facts_(std::move(calibration)), sys_(std::move(sys)) {}

RigHealth HealthMonitor::look(const RigCounters& counters, MonotonicTime now) {
    samples_.push_back({now, counters.captured, counters.published});
    // Keeps one sample that is at least as old as the rate window, or the first of all.
    while (samples_.size() > 2 && now - samples_[1].time >= rate_window) samples_.pop_front();
    RigHealth health = facts_;
    health.temperature_c = hottest_zone_c(sys_);
    health.under_voltage = has_under_voltage(sys_);
    const Sample& first = samples_.front();
    const float passed_s = std::chrono::duration<float>(now - first.time).count();
    if (passed_s > 0) {
        health.captured_hz = static_cast<float>(counters.captured - first.captured) / passed_s;
        health.published_hz = static_cast<float>(counters.published - first.published) / passed_s;
    }
    return health;
}

}  // namespace vantage

#include "rig_firmware/daemon/health_monitor.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/data_folder.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

class HealthMonitorTest : public testing::Test {
  protected:
    void write(const std::filesystem::path& file, const char* text) {
        std::filesystem::create_directories((sys() / file).parent_path());
        std::ofstream(sys() / file) << text;
    }
    std::filesystem::path sys() const { return folder_.path(); }

    TemporaryFolder folder_;
};

TEST_F(HealthMonitorTest, ShowsTheHottestZoneOfThoseThatCanBeRead) {
    EXPECT_EQ(hottest_zone_c(sys()), std::nullopt);
    write("class/thermal/thermal_zone0/temp", "48312\n");
    write("class/thermal/thermal_zone1/temp", "61250\n");
    write("class/thermal/thermal_zone2/temp", "");
    write("class/thermal/cooling_device0/type", "fan\n");
    ASSERT_TRUE(hottest_zone_c(sys()).has_value());
    EXPECT_FLOAT_EQ(*hottest_zone_c(sys()), 61.25f);
}

TEST_F(HealthMonitorTest, ShowsASupplyThatSags) {
    EXPECT_FALSE(has_under_voltage(sys()));
    write("class/hwmon/hwmon0/in0_lcrit_alarm", "0\n");
    write("class/hwmon/hwmon1/name", "nvme\n");
    EXPECT_FALSE(has_under_voltage(sys()));
    write("class/hwmon/hwmon2/in0_lcrit_alarm", "1\n");
    EXPECT_TRUE(has_under_voltage(sys()));
}

TEST_F(HealthMonitorTest, RatesAreThoseOfTheLastSeconds) {
    RigHealth facts;
    facts.calibration_id = "0123456789abcdef";
    HealthMonitor monitor(facts, sys());
    const MonotonicTime start{};
    RigCounters counters;
    EXPECT_EQ(monitor.look(counters, start), facts) << "nothing has happened yet";
    for (int second = 1; second <= 20; ++second) {
        counters.captured += second <= 10 ? 30 : 10;
        counters.published += 10;
        const RigHealth health = monitor.look(counters, start + second * 1s);
        EXPECT_EQ(health.calibration_id, facts.calibration_id);
        EXPECT_FLOAT_EQ(health.published_hz, 10);
        const bool is_settled = second <= 10 || second > 15;
        EXPECT_TRUE(!is_settled || health.captured_hz == (second <= 10 ? 30.0f : 10.0f))
            << health.captured_hz << " at " << second;
    }
}

}  // namespace
}  // namespace vantage

#include "rig_firmware/daemon/timecode.h"

#include <gtest/gtest.h>

#include "common/base/pulse_grid.h"

namespace vantage {
namespace {

TEST(TimeOfDayCode, CountsTheFramesOfEverySecond) {
    const PulseGrid grid(25);
    const std::uint64_t midnight = 25ull * 86'400 * 20'000;
    EXPECT_EQ(time_of_day_code(grid.time_of(midnight), 25), "00:00:00:00");
    EXPECT_EQ(time_of_day_code(grid.time_of(midnight + 24), 25), "00:00:00:24");
    EXPECT_EQ(time_of_day_code(grid.time_of(midnight + 25), 25), "00:00:01:00");
    EXPECT_EQ(time_of_day_code(grid.time_of(midnight - 1), 25), "23:59:59:24");
}

TEST(TimeOfDayCode, GivesEveryPulseOfASecondANumberOfItsOwn) {
    for (const int rate : {24, 30, 50, 60}) {
        const PulseGrid grid(rate);
        const std::uint64_t second = static_cast<std::uint64_t>(rate) * 1'795'219'261;
        for (int i = 0; i < rate; ++i)
            EXPECT_EQ(time_of_day_code(grid.time_of(second + static_cast<std::uint64_t>(i)), rate)
                          .substr(9),
                      (i < 10 ? "0" : "") + std::to_string(i));
    }
}

TEST(TimeOfDayCode, LetsFramesShareANumberWhereTwoDigitsAreTooFew) {
    for (const double rate : {119.88, 120.0, 200.0, 1000.0}) {
        const PulseGrid grid(rate);
        const std::uint64_t first =
            grid.index_at_or_before(TaiTime(std::chrono::seconds(1'795'219'261)));
        for (std::uint64_t i = first; i < first + 2000; ++i) {
            const std::string code = time_of_day_code(grid.time_of(i), rate);
            ASSERT_EQ(code.size(), 11u) << code;
            ASSERT_LT(std::stoi(code.substr(9)), 60) << code;
        }
    }
}

}  // namespace
}  // namespace vantage

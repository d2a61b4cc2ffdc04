#include "rig_firmware/trigger/pulse_sender.h"

#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/time/pulse_grid.h"
#include "rig_firmware/trigger/gpio_line.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

RigConfig::Trigger pretended() {
    RigConfig::Trigger trigger;
    trigger.role = "lead";
    trigger.pretended = true;
    trigger.exposure_us = 500;
    trigger.late_limit_us = 1e6;  // a test computer may be busy
    return trigger;
}

TEST(PulseSender, SendsNothingBeforeItIsStarted) {
    PulseSender sender(pretended(), 200);
    std::this_thread::sleep_for(50ms);
    EXPECT_FALSE(sender.started());
    EXPECT_EQ(sender.status().sent, 0u);
}

TEST(PulseSender, RecordsTheLatenessOfEveryPulse) {
    PulseSender sender(pretended(), 200);
    sender.start(0);
    while (sender.status().lateness_us.count < 20) std::this_thread::sleep_for(5ms);
    sender.stop();
    const PulseStatus status = sender.status();
    EXPECT_EQ(status.lateness_us.count, status.sent);
    EXPECT_GE(status.lateness_us.p50, 0);
    EXPECT_GE(status.lateness_us.max, status.lateness_us.p50);
    EXPECT_GE(status.width_error_us.p50, 0) << "a pulse is never cut short";
}

TEST(PulseSender, BeginsWithTheAnnouncedPulse) {
    const PulseGrid grid(200);
    PulseSender sender(pretended(), 200);
    const std::uint64_t first = grid.index_at_or_before(TaiClock::now()) + 40;
    sender.start(first);
    while (sender.status().lateness_us.count < 1) std::this_thread::sleep_for(1ms);
    EXPECT_GE(sender.status().last_index, first);
}

TEST(PulseSender, StopsAtOnceHoweverLongThePeriod) {
    PulseSender sender(pretended(), 0.01);
    sender.start(0);
    sender.stop();
    EXPECT_EQ(sender.status().sent, 0u);
}

TEST(PulseSender, ReportsPriorityAndLockedMemoryOrWhyNot) {
    RigConfig::Trigger trigger = pretended();
    trigger.realtime_priority = 0;
    const PulseSender sender(trigger, 200);
    const auto lines = sender.report();
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_THAT(lines[0], HasSubstr("pretended line"));
    EXPECT_THAT(lines[1], HasSubstr("without real-time priority, as configured"));
    EXPECT_THAT(lines[2], HasSubstr("memory is"));
}

TEST(GpioLine, SaysWhichChipIsNotThere) {
    RigConfig::Trigger trigger;
    trigger.chip = "pinctrl-of-nobody";
    trigger.line = "GPIO17";
    EXPECT_THAT(thrown_sentence([&] { find_gpio_line(trigger); }), HasSubstr("pinctrl-of-nobody"));
}

}  // namespace
}  // namespace vantage

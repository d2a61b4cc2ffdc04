#include "rig_firmware/trigger/rig_trigger.h"

#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/time/pulse_grid.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

RigConfig leading_rig(double rate_hz) {
    RigConfig config;
    config.name = "lead";
    config.source.rate_hz = rate_hz;
    config.trigger.role = "lead";
    config.trigger.pretended = true;
    return config;
}

TEST(RigTrigger, RefusesAFirstPulseThatAHostOfAnotherRateCounts) {
    const auto trigger = RigTrigger::make(leading_rig(0.5));
    const std::uint64_t of_host = PulseGrid(30).index_at_or_before(TaiClock::now()) + 60;
    EXPECT_THAT(thrown_sentence([&] { trigger->announce(of_host); }),
                testing::AllOf(HasSubstr("0.5 Hz"), HasSubstr("rate_hz in stage.toml")));
    std::this_thread::sleep_for(100ms);
    const TriggerStatus status = trigger->status();
    EXPECT_EQ(status.first_pulse, 0u);
    EXPECT_EQ(status.pulses + status.skipped, 0u);
}

TEST(RigTrigger, LeadsFromTheAnnouncedPulseOn) {
    const auto trigger = RigTrigger::make(leading_rig(100));
    const std::uint64_t first = PulseGrid(100).index_at_or_before(TaiClock::now()) + 5;
    trigger->announce(first);
    for (int i = 0; i < 1000 && trigger->status().pulses + trigger->status().skipped < 3; ++i)
        std::this_thread::sleep_for(10ms);
    EXPECT_GE(trigger->status().pulses + trigger->status().skipped, 3u);
    EXPECT_EQ(trigger->status().first_pulse, first);
}

}  // namespace
}  // namespace vantage

#include "rig_firmware/trigger/sensor_timing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using std::chrono::nanoseconds;
using testing::HasSubstr;

RigConfig::Trigger global_shutter(double exposure_us) {
    RigConfig::Trigger trigger;
    trigger.sensor = "imx296";
    trigger.exposure_us = exposure_us;
    return trigger;
}

TEST(SensorTiming, ShortensAnImx296sPulseByWhatItExposesLonger) {
    const SensorTiming timing = sensor_timing(global_shutter(6000), 30);
    EXPECT_EQ(timing.pulse_width(), nanoseconds(5'985'740));
    EXPECT_EQ(timing.exposure_centre(), nanoseconds(3'000'000));
    EXPECT_EQ(timing.timestamp_delay, nanoseconds(6'000'000));
}

TEST(SensorTiming, TakesGivenValuesBeforeTheModels) {
    RigConfig::Trigger trigger = global_shutter(6000);
    trigger.exposure_offset_us = 0;
    trigger.readout_us = 100;
    trigger.timestamp_delay_us = 7;
    const SensorTiming timing = sensor_timing(trigger, 150);
    EXPECT_EQ(timing.pulse_width(), nanoseconds(6'000'000));
    EXPECT_EQ(timing.readout, nanoseconds(100'000));
    EXPECT_EQ(timing.timestamp_delay, nanoseconds(7'000));
}

TEST(SensorTiming, RefusesWhatDoesNotFitAPeriodWithTheNumbers) {
    const std::string sentence = thrown_sentence([] { sensor_timing(global_shutter(20'000), 30); });
    EXPECT_THAT(sentence, HasSubstr("20000.00 us of exposure"));
    EXPECT_THAT(sentence, HasSubstr("16560.00 us of readout"));
    EXPECT_THAT(sentence, HasSubstr("33333.33 us"));
    EXPECT_THAT(sentence, HasSubstr("lower 'rate_hz' to 27.35 or 'exposure_us' to 16773"));
    EXPECT_NO_THROW(sensor_timing(global_shutter(16'773), 30));
    EXPECT_NO_THROW(sensor_timing(global_shutter(20'000), 27.35));
}

TEST(SensorTiming, RefusesAnExposureThatNoPulseGives) {
    EXPECT_THAT(thrown_sentence([] { sensor_timing(global_shutter(20), 30); }),
                HasSubstr("needs a pulse of 5.74 us"));
}

TEST(SensorTiming, NamesTheNearestModel) {
    RigConfig::Trigger trigger;
    trigger.sensor = "imx297";
    EXPECT_THAT(thrown_sentence([&] { sensor_timing(trigger, 30); }), HasSubstr("imx296"));
}

}  // namespace
}  // namespace vantage

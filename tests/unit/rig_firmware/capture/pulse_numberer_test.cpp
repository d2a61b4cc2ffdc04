#include "rig_firmware/capture/pulse_numberer.h"

#include <random>

#include <gtest/gtest.h>

#include "rig_firmware/capture/sequence_gaps.h"
#include "rig_firmware/clock/clock_pair.h"

namespace vantage {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class PulseNumbererTest : public testing::Test {
  protected:
    std::optional<std::uint64_t> number(double ms) {
        const auto index =
            numberer_.number(day_ + std::chrono::nanoseconds(static_cast<std::int64_t>(ms * 1e6)));
        if (!index) return std::nullopt;
        return *index - grid_.index_at_or_before(day_);
    }

    PulseGrid grid_{10};  // a pulse every 100 ms
    TaiTime day_{seconds(1'795'219'200)};
    PulseNumberer numberer_{grid_};
};

TEST_F(PulseNumbererTest, GivesTheNearestPulse) {
    EXPECT_EQ(number(160), 2u);
    EXPECT_EQ(number(340), 3u);
    EXPECT_EQ(number(440), 4u);
    EXPECT_EQ(numberer_.missed(), 0u);
}

TEST_F(PulseNumbererTest, IsSteadyForASensorInTheMiddleBetweenPulses) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> jitter(-20, 20);
    std::optional<std::uint64_t> last;
    for (int i = 0; i < 500; ++i) {
        const auto index = number(150 + 100 * i + jitter(random));
        ASSERT_TRUE(index) << i;
        if (last) {
            ASSERT_EQ(*index, *last + 1) << i;
        }
        last = index;
    }
    EXPECT_EQ(numberer_.missed() + numberer_.surplus(), 0u);
}

TEST_F(PulseNumbererTest, CountsWhatASlowSensorMisses) {
    std::uint64_t given = 0;
    for (int i = 0; i < 200; ++i) given += number(50.5 + 101 * i).has_value();  // 9.9 Hz
    EXPECT_EQ(given, 200u);
    EXPECT_EQ(numberer_.missed(), 1u) << "pulses 1 to 201";
    EXPECT_EQ(numberer_.surplus(), 0u);
}

TEST_F(PulseNumbererTest, CountsWhatAFastSensorHasTooMany) {
    std::uint64_t given = 0;
    for (int i = 0; i < 200; ++i) given += number(50.5 + 99 * i).has_value();
    EXPECT_EQ(given + numberer_.surplus(), 200u);
    EXPECT_EQ(numberer_.surplus(), 2u);
    EXPECT_EQ(numberer_.missed(), 0u);
}

TEST_F(PulseNumbererTest, CountsThePulsesWhileASensorWasGone) {
    number(100);
    EXPECT_EQ(number(5100), 51u);
    EXPECT_EQ(numberer_.missed(), 49u);
}

TEST_F(PulseNumbererTest, GoesBackWithAClockThatIsSetBack) {
    number(37'000);
    EXPECT_EQ(number(100), 1u);
    EXPECT_EQ(number(200), 2u);
    EXPECT_EQ(numberer_.clock_steps(), 1u);
    EXPECT_EQ(numberer_.missed(), 0u);
}

TEST(SequenceGaps, CountsWhatIsLeftOut) {
    SequenceGaps gaps;
    for (const std::uint32_t sequence : {17u, 18u, 21u, 22u}) gaps.see(sequence);
    EXPECT_EQ(gaps.lost(), 2u);
    gaps.see(3);
    EXPECT_EQ(gaps.lost(), 2u) << "a driver that begins again loses nothing";
    gaps.restart();
    gaps.see(100);
    EXPECT_EQ(gaps.lost(), 2u);
}

TEST(SequenceGaps, GoesOnWhereTheCountWraps) {
    SequenceGaps gaps;
    for (const std::uint32_t sequence : {0xfffffffeu, 0xffffffffu, 1u}) gaps.see(sequence);
    EXPECT_EQ(gaps.lost(), 1u);
}

TEST(ClockPair, CarriesOneClockToTheOther) {
    const ClockPair pair{tai_from_ns(5'000'000), monotonic_from_ns(2'000)};
    EXPECT_EQ(to_ns(pair.to_tai(monotonic_from_ns(1'500))), 4'999'500);
    const ClockPair now = ClockPair::now();
    EXPECT_GT(to_ns(now.tai), 0);
    EXPECT_LE(now.monotonic, MonotonicClock::now());
}

}  // namespace
}  // namespace vantage

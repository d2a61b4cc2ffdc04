#include "rig_firmware/clock/clock_model.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace vantage {
namespace {

using namespace std::chrono_literals;

/// A source clock beside a true one, read once a second.
class ClockModelTest : public testing::Test {
  protected:
    MonotonicTime source_at(std::chrono::nanoseconds true_time) const {
        const double drift = static_cast<double>(true_time.count()) * ppm_ * 1e-6;
        return monotonic_from_ns(5'000'000'000) + true_time +
               std::chrono::nanoseconds(std::llround(drift));
    }
    TaiTime tai_at(std::chrono::nanoseconds true_time) const {
        return tai_from_ns(1'795'000'000'000'000'000) + true_time + step_;
    }
    void observe(std::chrono::nanoseconds true_time, std::chrono::nanoseconds late = 0ns) {
        model_.observe(source_at(true_time), tai_at(true_time) + late);
    }
    std::chrono::nanoseconds error_at(std::chrono::nanoseconds true_time) const {
        const auto error = model_.to_tai(source_at(true_time)) - tai_at(true_time);
        return error < 0ns ? -error : error;
    }
    std::chrono::nanoseconds jitter() {
        return std::chrono::nanoseconds(std::uniform_int_distribution(-20'000, 20'000)(random_));
    }

    double ppm_ = 0;
    std::chrono::nanoseconds step_{};
    ClockModel model_;
    std::mt19937 random_{1};
};

TEST_F(ClockModelTest, CarriesTimesFromTheFirstPairOn) {
    EXPECT_FALSE(model_.ready());
    observe(0s);
    EXPECT_LE(error_at(1s), 1ns);
}

TEST_F(ClockModelTest, FollowsAClockThatRuns100PpmFast) {
    ppm_ = 100;
    for (int s = 0; s < 100; ++s) observe(std::chrono::seconds(s));
    EXPECT_NEAR(model_.state().ppm, 100, 0.1);
    EXPECT_LE(error_at(99s + 500ms), 100ns);
    EXPECT_LE(error_at(60s), 100ns) << "and backwards, for a frame that comes late";
}

TEST_F(ClockModelTest, AveragesJitterAway) {
    ppm_ = -30;
    for (int s = 0; s < 200; ++s) {
        observe(std::chrono::seconds(s), jitter());
        if (s > 64) {
            EXPECT_LE(error_at(std::chrono::seconds(s) + 100ms), 20us) << s;
        }
    }
    EXPECT_NEAR(model_.state().ppm, -30, 1);
    EXPECT_NEAR(model_.state().residual_ns, 11'500, 4'000) << "uniform over 40 us";
}

TEST_F(ClockModelTest, BridgesGapsAndLeavesDuplicatesOut) {
    ppm_ = 100;
    for (int s = 0; s < 70; ++s) {
        observe(std::chrono::seconds(s));
        observe(std::chrono::seconds(s));
    }
    EXPECT_EQ(model_.state().pairs, 70u);
    observe(70s + 10min);
    EXPECT_EQ(model_.state().steps, 0u);
    EXPECT_LE(error_at(70s + 10min + 1s), 1us);
}

TEST_F(ClockModelTest, FollowsAClockThatIsSetAfterOneMorePair) {
    for (int s = 0; s < 20; ++s) observe(std::chrono::seconds(s));
    step_ = 37s;
    observe(20s);
    EXPECT_EQ(model_.state().steps, 0u);
    observe(21s);
    EXPECT_EQ(model_.state().steps, 1u);
    EXPECT_NEAR(model_.state().last_step_ns, 37e9, 100);
    EXPECT_LE(error_at(22s), 10ns);
    step_ = -2h;
    observe(22s);
    observe(23s);
    EXPECT_EQ(model_.state().steps, 2u);
    EXPECT_LE(error_at(24s), 10ns);
    EXPECT_EQ(model_.state().outliers, 0u);
}

TEST_F(ClockModelTest, LeavesASingleBadReadingOut) {
    for (int s = 0; s < 20; ++s) observe(std::chrono::seconds(s));
    observe(20s, 5ms);
    observe(21s);
    EXPECT_EQ(model_.state().outliers, 1u);
    EXPECT_EQ(model_.state().steps, 0u);
    EXPECT_LE(error_at(22s), 10ns);
}

TEST_F(ClockModelTest, StaysTrueFor24HoursOfADriftingCrystal) {
    // The rate wanders by 2 ppm over the day, as with the temperature.
    double source_ns = 0;
    std::chrono::nanoseconds worst{};
    for (int s = 0; s < 24 * 3600; ++s) {
        constexpr double day_s = 86'400, two_pi = 6.283185307179586;
        source_ns += 1e9 * (1 + (100 + 2 * std::sin(two_pi * s / day_s)) * 1e-6);
        const MonotonicTime source = monotonic_from_ns(std::llround(source_ns));
        const TaiTime tai = tai_at(std::chrono::seconds(s));
        if (s > 64) {
            const auto error = model_.to_tai(source) - tai;
            worst = std::max(worst, error < 0ns ? -error : error);
        }
        model_.observe(source, tai + jitter() / 10);
    }
    EXPECT_LE(worst, 5us);
    EXPECT_EQ(model_.state().steps, 0u);
    EXPECT_EQ(model_.state().outliers, 0u);
}

}  // namespace
}  // namespace vantage

#include "host_app/programme/governor.h"

#include <functional>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

/// A chooser among four levels. Work has 10 ms, of which it may take 8.
class LevelChooserTest : public testing::Test {
  protected:
    static constexpr double time_ms = 10;
    static constexpr std::chrono::milliseconds tick{20};

    /// Records one work at the present level.
    void work(double ms) {
        chooser_.saw(chooser_.level(), ms, time_ms, now_);
        now_ += tick;
    }
    /// Records work for a given time, each with the cost of its level. Returns the times at which
    /// the level rose.
    std::vector<MonotonicTime> run_for(std::chrono::nanoseconds time,
                                       const std::function<double(std::size_t)>& cost_ms) {
        std::vector<MonotonicTime> rises;
        for (const MonotonicTime end = now_ + time; now_ < end;) {
            const std::size_t before = chooser_.level();
            work(cost_ms(before));
            if (chooser_.level() < before) rises.push_back(now_);
        }
        return rises;
    }
    double seconds_since(MonotonicTime start) const {
        return std::chrono::duration<double>(now_ - start).count();
    }

    LevelChooser chooser_{4, 0.8};
    MonotonicTime now_{1h};
};

TEST_F(LevelChooserTest, FallsAfterThreeMisfitsInARow) {
    work(9);
    work(9);
    work(7);
    work(9);
    work(9);
    EXPECT_EQ(chooser_.level(), 0u) << "one work in between fitted";
    work(9);
    EXPECT_EQ(chooser_.level(), 1u);
}

TEST_F(LevelChooserTest, FallsSoonerAndFurtherForVeryLongWork) {
    work(40);
    EXPECT_EQ(chooser_.level(), 0u) << "a single one may include compilation";
    work(40);
    EXPECT_EQ(chooser_.level(), 3u);
}

TEST_F(LevelChooserTest, IgnoresWorkOfThePreviousLevel) {
    for (int i = 0; i < 3; ++i) work(9);
    for (int i = 0; i < 9; ++i) chooser_.saw(0, 30, time_ms, now_);
    EXPECT_EQ(chooser_.level(), 1u) << "this work was started before the level fell";
}

TEST_F(LevelChooserTest, StaysAtTheCheapestLevel) {
    for (int i = 0; i < 100; ++i) work(50);
    EXPECT_EQ(chooser_.level(), 3u);
}

TEST_F(LevelChooserTest, RisesAfterTwoSecondsWithRoom) {
    for (int i = 0; i < 3; ++i) work(9);
    const MonotonicTime fallen = now_;
    run_for(1900ms, [](std::size_t) { return 2; });
    EXPECT_EQ(chooser_.level(), 1u);
    run_for(300ms, [](std::size_t) { return 2; });
    EXPECT_EQ(chooser_.level(), 0u) << seconds_since(fallen) << " s after it fell";
}

TEST_F(LevelChooserTest, RisesFromTheCheapestLevelAsSoon) {
    while (chooser_.level() < 3) work(50);
    run_for(7s, [](std::size_t) { return 2; });
    EXPECT_EQ(chooser_.level(), 0u)
        << "the level that was skipped in the fall was not a failed rise";
}

TEST_F(LevelChooserTest, DoesNotRiseWithoutRoom) {
    for (int i = 0; i < 3; ++i) work(9);
    run_for(60s, [](std::size_t) { return 6; });
    EXPECT_EQ(chooser_.level(), 1u) << "the better level is more expensive, and this one just fits";
}

/// The readback takes the same time at every level.
TEST_F(LevelChooserTest, TriesBetterLevelsIfTheCheapestHasRoom) {
    chooser_.begin_with_the_cheapest();
    run_for(10s, [](std::size_t level) { return 5.8 - 0.1 * static_cast<double>(level); });
    EXPECT_EQ(chooser_.level(), 0u);
}

TEST_F(LevelChooserTest, TriesALevelThatIsExpectedToMissOnlyOnce) {
    chooser_.begin_with_the_cheapest();
    const std::vector<MonotonicTime> rises =
        run_for(60s, [](std::size_t level) { return level == 3 ? 5 : 12; });
    EXPECT_EQ(rises.size(), 1u);
    EXPECT_EQ(chooser_.level(), 3u);
}

TEST_F(LevelChooserTest, ExpectsTheBestLevelToTakeAsManyTimesTheNextOneAsItIsTold) {
    chooser_ = LevelChooser(4, 0.8, 4);
    chooser_.begin_with_the_cheapest();
    const auto cost_ms = [](std::size_t level) { return level == 0 ? 12 : 3; };
    EXPECT_EQ(run_for(60s, cost_ms).size(), 2u);
    EXPECT_EQ(chooser_.level(), 1u);
    run_for(3s, [](std::size_t) { return 1; });
    EXPECT_EQ(chooser_.level(), 0u) << "four times 1 ms fit";
}

TEST_F(LevelChooserTest, DoesNotRiseWhileRoomComesAndGoes) {
    for (int i = 0; i < 3; ++i) work(9);
    for (int i = 0; i < 60; ++i) {
        run_for(1s, [](std::size_t) { return 2; });
        for (int j = 0; j < 5; ++j) work(7.5);
    }
    EXPECT_EQ(chooser_.level(), 1u);
}

TEST_F(LevelChooserTest, WaitsLongerAfterEachFailedRise) {
    const std::vector<MonotonicTime> rises =
        run_for(600s, [](std::size_t level) { return level == 0 ? 12 : 3; });
    ASSERT_GE(rises.size(), 4u) << "it keeps trying";
    EXPECT_LE(rises.size(), 15u) << "and does not oscillate";
    for (std::size_t i = 2; i < rises.size(); ++i)
        EXPECT_GE(rises[i] - rises[i - 1] + 2 * tick, rises[i - 1] - rises[i - 2]) << i;
    EXPECT_GE(rises.back() - rises[rises.size() - 2], 30s);
    EXPECT_LE(rises.back() - rises[rises.size() - 2], 62s) << "it does not give up";
}

TEST_F(LevelChooserTest, RisesQuicklyAgainAfterALevelHeld) {
    run_for(100s, [](std::size_t level) { return level == 0 ? 12 : 3; });
    run_for(100s, [](std::size_t) { return 2; });
    ASSERT_EQ(chooser_.level(), 0u);
    for (int i = 0; i < 3; ++i) work(9);
    ASSERT_EQ(chooser_.level(), 1u);
    run_for(2200ms, [](std::size_t) { return 2; });
    EXPECT_EQ(chooser_.level(), 0u);
}

TEST_F(LevelChooserTest, StaysAtAFixedLevel) {
    chooser_.fix(2);
    run_for(10s, [](std::size_t) { return 50; });
    EXPECT_EQ(chooser_.level(), 2u);
    run_for(10s, [](std::size_t) { return 1; });
    EXPECT_EQ(chooser_.level(), 2u);
    chooser_.fix(99);
    EXPECT_EQ(chooser_.level(), 3u) << "there is no cheaper one";
}

TEST_F(LevelChooserTest, ReportsTheShareOfTimeOfEveryLevel) {
    for (const double share : chooser_.shares(now_)) EXPECT_EQ(share, 0) << "before the first work";
    const MonotonicTime start = now_;
    run_for(30s, [](std::size_t) { return 2; });
    for (int i = 0; i < 3; ++i) work(12);
    const double at_best_s = seconds_since(start);
    run_for(10s, [](std::size_t) { return 7; });
    const std::vector<double> shares = chooser_.shares(now_);
    EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), 1, 1e-9);
    EXPECT_NEAR(shares[0], at_best_s / seconds_since(start), 0.01);
    EXPECT_NEAR(shares[1], 1 - shares[0], 1e-9);
}

TEST(Governor, LowersBothLevelsIndependently) {
    Governor governor(50, 25, {});
    MonotonicTime now{1h};
    const auto tick = [&](double render_ms, double prepare_ms) {
        governor.saw_render(governor.render(), render_ms, false, now);
        governor.saw_prepare(governor.prepare().rank, prepare_ms, now);
        now += 40ms;
    };
    EXPECT_EQ(governor.render().rank, static_cast<int>(render_levels().size()) - 1) << "at first";
    for (int i = 0; i < 250; ++i) tick(1, 1);
    ASSERT_EQ(governor.render().rank, 0);
    ASSERT_EQ(governor.prepare().rank, 0);
    for (int i = 0; i < 3; ++i) tick(17, 27);
    EXPECT_EQ(governor.render().rank, 1) << "13 of 20 ms are available";
    EXPECT_EQ(governor.prepare().rank, 0) << "28 of 40 ms are available";
    for (int i = 0; i < 3; ++i) tick(5, 39);
    EXPECT_EQ(governor.prepare().rank, 1);
}

/// Rendering has priority and would leave no time for instants on a computer that is too slow for
/// both.
TEST(Governor, ReducesRenderingIfTheCheapestInstantsAreLate) {
    Governor governor(25, 5, {});
    MonotonicTime now{1h};
    const auto run_for = [&](int pulses, double render_ms, double prepare_ms) {
        for (int i = 0; i < pulses; ++i) {
            for (int tick = 0; tick < 5; ++tick, now += 40ms)
                governor.saw_render(governor.render(), render_ms, false, now);
            governor.saw_prepare(governor.prepare().rank, prepare_ms, now);
        }
    };
    run_for(100, 12.1, 120);
    const int beside_instants = governor.render().rank;
    run_for(20, 12.1, 400);
    ASSERT_EQ(governor.prepare().rank, static_cast<int>(prepare_levels().size()) - 1);
    EXPECT_GT(governor.render().rank, beside_instants) << "12 of 40 ms are too much now";
    run_for(200, 5, 100);
    EXPECT_EQ(governor.render().rank, 0) << "they fit again";
}

TEST(Governor, AllowsReprojectedFramesMoreThanATickIfPulsesAreRare) {
    const auto rank_after = [](double pulse_rate_hz, bool is_carried_on) {
        Governor governor(25, pulse_rate_hz, {});
        MonotonicTime now{1h};
        for (int tick = 0; tick < 500; ++tick, now += 40ms)
            governor.saw_render(governor.render(), 30, is_carried_on, now);
        return governor.render().rank;
    };
    const int cheapest = static_cast<int>(render_levels().size()) - 1;
    EXPECT_EQ(rank_after(4, true), 0) << "65 of 100 ms are available";
    EXPECT_EQ(rank_after(4, false), cheapest) << "26 of 40 ms are available";
    EXPECT_EQ(rank_after(25, true), cheapest) << "every pulse needs a frame";
}

/// An instant may take the time between two pulses, but after a jump it must be faster.
TEST(Governor, PreparesTheTargetOfAJumpAtACheapLevel) {
    Governor governor(25, 5, {});
    MonotonicTime now{1h};
    const auto work = [&](double ms) {
        governor.saw_prepare(governor.prepare().rank, ms, now);
        now += 200ms;
    };
    const int cheapest = static_cast<int>(prepare_levels().size()) - 1;
    EXPECT_EQ(governor.prepare_sought().rank, cheapest) << "nothing is known yet";
    for (int i = 0; i < 100; ++i) work(10);
    ASSERT_EQ(governor.prepare().rank, 0);
    EXPECT_EQ(governor.prepare_sought().rank, 0);
    for (int i = 0; i < 100; ++i) work(130);
    EXPECT_EQ(governor.prepare().rank, 0) << "140 of 200 ms are available";
    EXPECT_EQ(governor.prepare_sought().rank, 1) << "this level takes 10 ms";

    Governor fixed(25, 5, {1});
    for (int i = 0; i < 10; ++i) fixed.saw_prepare(1, 130, now);
    EXPECT_EQ(fixed.prepare_sought().rank, 1) << "the requested level";
}

TEST(Governor, KeepsARequestedLevel) {
    Governor governor(50, 25, {2});
    MonotonicTime now{1h};
    for (int i = 0; i < 300; ++i, now += 20ms) {
        governor.saw_render(governor.render(), 100, false, now);
        governor.saw_prepare(governor.prepare().rank, 1, now);
    }
    EXPECT_EQ(governor.render().rank, 2);
    EXPECT_EQ(governor.prepare().rank, 2);
    EXPECT_EQ(governor.render_shares(now)[2], 1);
}

TEST(QualityRequest, ReadsBestAutoAndNumbers) {
    EXPECT_FALSE(QualityRequest::parse("auto").level);
    EXPECT_EQ(QualityRequest::parse("best").level, 0u);
    for (std::size_t level = 0; level < render_levels().size(); ++level)
        EXPECT_EQ(QualityRequest::parse(std::to_string(level)).level, level);
}

TEST(QualityRequest, RejectsOtherValuesAndNamesTheValidOnes) {
    const std::string beyond = std::to_string(render_levels().size());
    for (const std::string text :
         {"", "high", "-1", "1.5", "2 ", "+1", beyond.c_str(), "99999999999999999999"}) {
        const std::string sentence = thrown_sentence([&] { QualityRequest::parse(text); });
        EXPECT_NE(sentence.find("best, auto or a level from 0"), std::string::npos) << sentence;
        EXPECT_NE(sentence.find("'" + text + "'"), std::string::npos) << sentence;
    }
}

TEST(GovernorTest, SlowMotionHasAsManyMomentsAsTimeAllows) {
    Governor governor(50, 25, {});
    EXPECT_EQ(governor.moments_a_pulse(0.1), 1) << "nothing is known yet";
    governor.saw_past_instant(10);
    EXPECT_EQ(governor.moments_a_pulse(0.5), 2);
    EXPECT_EQ(governor.moments_a_pulse(0.25), 4);
    EXPECT_EQ(governor.moments_a_pulse(-0.1), 10) << "at most as many per second as live pulses";
    EXPECT_EQ(governor.moments_a_pulse(0.75), 1);
    EXPECT_EQ(governor.moments_a_pulse(1), 1);
    EXPECT_EQ(governor.moments_a_pulse(0), 1);
    governor.saw_past_instant(100);
    EXPECT_EQ(governor.moments_a_pulse(0.1), 3) << "a pulse lasts 400 ms at this speed";
    EXPECT_EQ(governor.moments_a_pulse(0.5), 1);
    for (int i = 0; i < 5; ++i) governor.saw_past_instant(10);
    EXPECT_EQ(governor.moments_a_pulse(0.1), 10);
}

}  // namespace
}  // namespace vantage

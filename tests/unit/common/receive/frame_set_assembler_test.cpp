#include "common/receive/frame_set_assembler.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vantage {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr auto pulse_period = 40ms;
constexpr auto budget = 200ms;

/// A stage whose frames arrive as the test says, on a clock of the test's own.
class Stage {
  public:
    explicit Stage(std::size_t rigs) : assembler_(names(rigs), {pulse_period, budget}) {
        for (std::size_t rig = 0; rig < rigs; ++rig) assembler_.set_connected(rig, true);
    }

    FrameFate frame(std::size_t rig, std::uint64_t index, std::uint64_t session = 1,
                    bool synchronized = true) {
        auto frame = std::make_shared<RigFrame>();
        frame->trigger_index = index;
        frame->session = session;
        frame->synchronized = synchronized;
        const FrameFate fate = assembler_.add(rig, std::move(frame), now_);
        ++fates_[fate];
        return fate;
    }

    /// Moves the clock to when pulse `index` is fired, plus `latency`.
    void at(std::uint64_t index, std::chrono::nanoseconds latency) {
        now_ =
            monotonic_from_ns(0) + 1h + static_cast<std::int64_t>(index) * pulse_period + latency;
    }
    void pass(std::chrono::nanoseconds time) { now_ += time; }

    std::vector<FrameSet> closed() { return assembler_.take_closed(now_); }
    std::vector<std::uint64_t> closed_indices() {
        std::vector<std::uint64_t> indices;
        for (const FrameSet& set : closed()) indices.push_back(set.trigger_index);
        return indices;
    }

    FrameSetAssembler& assembler() { return assembler_; }
    MonotonicTime now() const { return now_; }
    int count(FrameFate fate) { return fates_[fate]; }

  private:
    static std::vector<std::string> names(std::size_t rigs) {
        std::vector<std::string> all;
        for (std::size_t rig = 0; rig < rigs; ++rig) all.push_back("rig-" + std::to_string(rig));
        return all;
    }

    FrameSetAssembler assembler_;
    MonotonicTime now_ = monotonic_from_ns(0) + 1h;
    std::map<FrameFate, int> fates_;
};

/// Brings all rigs into play with pulse `index`, as far as they are not.
void start(Stage& stage, std::size_t rigs, std::uint64_t index) {
    stage.at(index, 10ms);
    for (std::size_t rig = 0; rig < rigs; ++rig) stage.frame(rig, index);
    stage.closed();
}

/// Pulse `index` of the stage's rate by rig 0, and the same moment as rigs at thrice that number
/// it.
void one_at_the_rate_of_three(Stage& stage, std::uint64_t index) {
    stage.at(index, 10ms);
    for (const std::size_t rig : {1, 2}) stage.frame(rig, 3 * index);
    stage.frame(0, index);
}

TEST(FrameSetAssembler, RigsAtAnotherRateDoNotAffectTheRigAtTheStagesRate) {
    Stage stage(3);
    for (const std::size_t rig : {1, 2}) stage.assembler().set_at_stage_rate(rig, false);
    one_at_the_rate_of_three(stage, 1000);
    for (std::uint64_t index = 1001; index <= 1010; ++index) {
        one_at_the_rate_of_three(stage, index);
        EXPECT_THAT(stage.closed_indices(), testing::Contains(index));
    }
    EXPECT_EQ(stage.count(FrameFate::in_frame_set), 11 + 2)
        << "the first ones came before any other";
    EXPECT_EQ(stage.count(FrameFate::out_of_step), 2 * 10);
}

TEST(FrameSetAssembler, RigsThatAreAllAtAnotherRateAreJoined) {
    Stage stage(2);
    for (const std::size_t rig : {0, 1}) stage.assembler().set_at_stage_rate(rig, false);
    for (std::uint64_t index = 1000; index < 1010; ++index) {
        stage.at(3 * index, 10ms);
        for (const std::size_t rig : {0, 1})
            EXPECT_EQ(stage.frame(rig, index), FrameFate::in_frame_set) << index;
        EXPECT_THAT(stage.closed_indices(), ElementsAre(index));
    }
}

TEST(FrameSetAssembler, WaitsForALaggingRigAgainOnceItIsInTime) {
    Stage stage(2);
    start(stage, 2, 100);
    std::uint64_t index = 101;
    // Rig 1 has the pulse of ten before, as if its clock had been set back.
    const auto lag = [&] {
        stage.at(index, 10ms);
        stage.frame(0, index++);
        stage.frame(1, index - 10);
    };
    for (int i = 0; i < 20; ++i) {
        lag();
        if (stage.assembler().lags(1)) break;
        EXPECT_THAT(stage.closed_indices(), testing::Not(testing::Contains(index - 1)))
            << "it is waited for";
    }
    ASSERT_TRUE(stage.assembler().lags(1));
    stage.closed();
    for (int i = 0; i < 5; ++i) {
        lag();
        EXPECT_THAT(stage.closed_indices(), testing::Contains(index - 1));
    }
    // From now on it is 50 ms behind the other, which is within the budget.
    stage.at(index, 10ms);
    stage.frame(0, index);
    EXPECT_THAT(stage.closed_indices(), ElementsAre(index));
    stage.pass(50ms);
    EXPECT_EQ(stage.frame(1, index), FrameFate::late);
    EXPECT_FALSE(stage.assembler().lags(1));
    stage.at(++index, 10ms);
    stage.frame(0, index);
    EXPECT_THAT(stage.closed_indices(), IsEmpty());
    stage.pass(50ms);
    EXPECT_EQ(stage.frame(1, index), FrameFate::in_frame_set);
    EXPECT_THAT(stage.closed_indices(), ElementsAre(index));
}

TEST(FrameSetAssembler, AFrameSetClosesWhenEveryRigHasDelivered) {
    Stage stage(3);
    start(stage, 3, 100);
    stage.at(101, 10ms);
    stage.frame(2, 101);
    stage.frame(0, 101);
    EXPECT_THAT(stage.closed(), IsEmpty());
    stage.frame(1, 101);
    const auto sets = stage.closed();
    ASSERT_EQ(sets.size(), 1u);
    EXPECT_EQ(sets[0].present(), 3);
    EXPECT_EQ(sets[0].slots[1].rig, "rig-1");
    EXPECT_EQ(sets[0].slots[1].frame->trigger_index, 101u);
    EXPECT_EQ(sets[0].complete, stage.now());
}

TEST(FrameSetAssembler, ALateRigIsAbsentAndMarkedLate) {
    Stage stage(3);
    start(stage, 3, 100);
    stage.at(101, 10ms);
    stage.frame(0, 101);
    stage.frame(1, 101);
    EXPECT_EQ(stage.assembler().next_deadline(), stage.now() + budget);
    stage.pass(budget - 1ns);
    EXPECT_THAT(stage.closed(), IsEmpty());
    stage.pass(1ns);
    const auto sets = stage.closed();
    ASSERT_EQ(sets.size(), 1u);
    EXPECT_EQ(sets[0].present(), 2);
    EXPECT_EQ(sets[0].slots[2].absence, Absence::late);
    EXPECT_EQ(sets[0].slots[0].absence, Absence::none);
    EXPECT_EQ(stage.frame(2, 101), FrameFate::late);
    EXPECT_FALSE(stage.assembler().next_deadline());
}

TEST(FrameSetAssembler, ARigThatSkipsAPulseMissedIt) {
    Stage stage(2);
    start(stage, 2, 100);
    stage.at(101, 10ms);
    stage.frame(0, 101);
    stage.at(102, 10ms);
    stage.frame(1, 102);
    const auto sets = stage.closed();
    ASSERT_EQ(sets.size(), 1u);
    EXPECT_EQ(sets[0].trigger_index, 101u);
    EXPECT_EQ(sets[0].slots[1].absence, Absence::missed_by_rig);
}

TEST(FrameSetAssembler, ARigThatNeverCameDelaysNothing) {
    Stage stage(2);
    stage.assembler().set_connected(1, false);
    for (std::uint64_t k = 1; k < 20; ++k) {
        stage.at(k, 10ms);
        stage.frame(0, k);
        const auto sets = stage.closed();
        ASSERT_EQ(sets.size(), 1u);
        EXPECT_EQ(sets[0].slots[1].absence, Absence::disconnected);
    }
}

TEST(FrameSetAssembler, DoesNotWaitForADisconnectedRig) {
    Stage stage(2);
    start(stage, 2, 100);
    stage.at(101, 10ms);
    stage.frame(0, 101);
    EXPECT_THAT(stage.closed(), IsEmpty()) << "it may be on its way";
    stage.assembler().set_connected(1, false);
    const auto without = stage.closed();
    ASSERT_EQ(without.size(), 1u);
    EXPECT_EQ(without[0].slots[1].absence, Absence::disconnected);
    stage.at(102, 10ms);
    stage.frame(0, 102);
    EXPECT_THAT(stage.closed_indices(), ElementsAre(102));

    stage.assembler().set_connected(1, true);
    stage.at(103, 10ms);
    stage.frame(1, 103);
    stage.frame(0, 103);
    EXPECT_EQ(stage.closed().at(0).present(), 2);
    stage.at(104, 10ms);
    stage.frame(0, 104);
    EXPECT_THAT(stage.closed(), IsEmpty()) << "it is waited for again";
}

TEST(FrameSetAssembler, WaitsForARigOnlyAtItsRequestedPulses) {
    Stage stage(2);
    start(stage, 2, 100);
    stage.assembler().set_asked(1, 3);
    for (const std::uint64_t k : {101, 103}) {
        stage.at(k, 10ms);
        stage.frame(0, k);
        const auto sets = stage.closed();
        ASSERT_EQ(sets.size(), 1u);
        EXPECT_EQ(sets[0].slots[1].absence, Absence::not_asked);
        stage.at(k + 1, 10ms);
        stage.frame(0, k + 1);
        stage.frame(1, k + 1);
        stage.closed();
    }
    stage.at(105, 10ms);
    stage.frame(0, 105);
    EXPECT_THAT(stage.closed(), IsEmpty());
    stage.assembler().set_asked(1, 0);
    EXPECT_THAT(stage.closed_indices(), ElementsAre(105)) << "asked to stop";
}

TEST(FrameSetAssembler, WaitsForRigsWithFewRequestedPulses) {
    Stage stage(2);
    for (const std::size_t rig : {0, 1}) stage.assembler().set_asked(rig, 50);
    start(stage, 2, 100);
    stage.at(150, 10ms);
    stage.frame(0, 150);
    EXPECT_THAT(stage.closed(), IsEmpty());
    stage.frame(1, 150);
    EXPECT_EQ(stage.closed().at(0).present(), 2);
}

TEST(FrameSetAssembler, WaitsForASilentRigForTheBudgetAndTwoPeriods) {
    Stage stage(2);
    start(stage, 2, 100);
    const MonotonicTime silent_since = stage.now();
    for (std::uint64_t k = 101; k < 130; ++k) {
        stage.at(k, 10ms);
        stage.closed();
        stage.frame(0, k);
        const bool waited_for = !stage.assembler().take_closed(stage.now()).size();
        EXPECT_EQ(waited_for, stage.now() - silent_since <= budget + 2 * pulse_period) << k;
    }
}

TEST(FrameSetAssembler, WaitsForRigsOnASlowStage) {
    FrameSetAssembler assembler({"a", "b"}, {5s, 200ms});
    const auto frame = [](std::uint64_t index) {
        auto made = std::make_shared<RigFrame>();
        made->trigger_index = index;
        made->synchronized = true;
        return made;
    };
    for (const std::size_t rig : {0, 1}) assembler.set_connected(rig, true);
    MonotonicTime now = monotonic_from_ns(0) + 1h;
    for (const std::size_t rig : {0, 1}) assembler.add(rig, frame(100), now);
    assembler.take_closed(now);
    now += 5s;
    assembler.add(0, frame(101), now);
    EXPECT_THAT(assembler.take_closed(now), IsEmpty());
    assembler.add(1, frame(101), now + 20ms);
    EXPECT_EQ(assembler.take_closed(now + 20ms).at(0).present(), 2);
}

TEST(FrameSetAssembler, JitterWithinTheBudgetCostsNoFrame) {
    Stage stage(4);
    std::mt19937 random(5);
    std::uniform_int_distribution<int> jitter_ms(0, 150);
    // Every rig keeps its own order, as a link does; between rigs everything goes.
    struct Arrival {
        std::chrono::nanoseconds time;
        std::size_t rig;
        std::uint64_t index;
    };
    std::vector<Arrival> arrivals;
    std::vector<std::chrono::nanoseconds> newest(4, 0ns);
    constexpr std::uint64_t pulses = 300;
    for (std::uint64_t k = 1; k <= pulses; ++k)
        for (std::size_t rig = 0; rig < 4; ++rig) {
            const std::chrono::nanoseconds arrival = static_cast<std::int64_t>(k) * pulse_period +
                                                     std::chrono::milliseconds(jitter_ms(random));
            newest[rig] = std::max(newest[rig], arrival);
            arrivals.push_back({newest[rig], rig, k});
        }
    std::stable_sort(arrivals.begin(), arrivals.end(),
                     [](const Arrival& a, const Arrival& b) { return a.time < b.time; });
    std::uint64_t last = 0;
    int complete = 0;
    for (const Arrival& arrival : arrivals) {
        stage.at(0, arrival.time);
        stage.frame(arrival.rig, arrival.index);
        for (const FrameSet& set : stage.closed()) {
            EXPECT_GT(set.trigger_index, last);
            last = set.trigger_index;
            complete += set.present() == 4;
        }
    }
    // Only the first pulses, before every rig was in play, may be closed without waiting.
    EXPECT_GE(complete, static_cast<int>(pulses) - 5);
    EXPECT_LE(stage.count(FrameFate::late), 15);
    EXPECT_EQ(stage.count(FrameFate::out_of_step), 0);
    EXPECT_EQ(stage.assembler().open_frame_sets(), 0u);
}

TEST(FrameSetAssembler, RigsThatStartLaterJoinWithTheirFirstFrame) {
    Stage stage(2);
    for (std::uint64_t k = 1; k < 10; ++k) {
        stage.at(k, 10ms);
        stage.frame(0, k);
        EXPECT_EQ(stage.closed().at(0).present(), 1);
    }
    stage.at(10, 10ms);
    stage.frame(1, 10);
    stage.frame(0, 10);
    EXPECT_EQ(stage.closed().at(0).present(), 2);
}

TEST(FrameSetAssembler, GapsOfThePulseCountStayGaps) {
    Stage stage(2);
    start(stage, 2, 100);
    for (const std::uint64_t k : {101, 102, 105, 109}) {
        stage.at(k, 10ms);
        stage.frame(0, k);
        stage.frame(1, k);
        EXPECT_THAT(stage.closed_indices(), ElementsAre(k));
    }
}

TEST(FrameSetAssembler, ASecondFrameOfAPulseIsADuplicateAndTheFirstStays) {
    Stage stage(2);
    start(stage, 2, 100);
    stage.at(101, 10ms);
    stage.frame(0, 101, 1);
    EXPECT_EQ(stage.frame(0, 101, 1), FrameFate::duplicate);
    stage.frame(1, 101);
    EXPECT_EQ(stage.closed().at(0).present(), 2);
    EXPECT_EQ(stage.frame(0, 101, 1), FrameFate::late);
}

TEST(FrameSetAssembler, FrameSetsCloseInTheOrderOfTheirPulses) {
    Stage stage(3);
    start(stage, 3, 100);
    stage.at(101, 10ms);
    stage.frame(1, 102);
    stage.frame(0, 101);
    stage.frame(0, 102);
    stage.pass(budget);
    EXPECT_THAT(stage.closed_indices(), ElementsAre(101, 102));
}

TEST(FrameSetAssembler, OpenFrameSetsAreBounded) {
    Stage stage(2);
    start(stage, 2, 100);
    // A burst within one instant: nothing can time out.
    stage.at(100 + 40, 0ms);
    std::size_t closed = 0;
    for (std::uint64_t k = 101; k < 141; ++k) {
        stage.frame(0, k);
        EXPECT_LE(stage.assembler().open_frame_sets(), FrameSetAssembler::max_open_frame_sets);
    }
    closed = stage.closed().size();
    EXPECT_GE(closed, 40 - FrameSetAssembler::max_open_frame_sets);
}

TEST(FrameSetAssembler, ARestartedRigThatKeepsCountingInStepIsJoinedAtOnce) {
    Stage stage(2);
    start(stage, 2, 100);
    stage.at(130, 10ms);
    stage.frame(0, 130, 1);
    stage.closed();
    stage.at(131, 10ms);
    stage.frame(1, 131, 2);
    stage.frame(0, 131, 1);
    const auto sets = stage.closed();
    ASSERT_FALSE(sets.empty());
    EXPECT_EQ(sets.back().present(), 2);
}

class JumpTest : public testing::TestWithParam<std::int64_t> {};

TEST_P(JumpTest, ARigOutOfStepIsExcludedWithoutAffectingOthers) {
    Stage stage(3);
    constexpr std::uint64_t begin = 1'000'000;
    start(stage, 3, begin);
    for (std::uint64_t k = begin + 1; k < begin + 60; ++k) {
        stage.at(k, 10ms);
        const auto jumped = static_cast<std::uint64_t>(static_cast<std::int64_t>(k) + GetParam());
        EXPECT_EQ(stage.frame(2, jumped, 2), FrameFate::out_of_step);
        stage.frame(0, k);
        stage.frame(1, k);
        const auto sets = stage.closed();
        ASSERT_EQ(sets.size(), 1u);
        EXPECT_EQ(sets[0].trigger_index, k);
        EXPECT_EQ(sets[0].present(), 2);
        EXPECT_EQ(sets[0].slots[2].absence, Absence::out_of_step);
    }
    // It comes to its senses and is taken back.
    constexpr std::uint64_t k = begin + 60;
    stage.at(k, 10ms);
    stage.frame(2, k, 3);
    stage.frame(0, k);
    stage.frame(1, k);
    EXPECT_EQ(stage.closed().at(0).present(), 3);
}

TEST_P(JumpTest, FollowsAStageThatIsRestartedRigByRig) {
    Stage stage(3);
    constexpr std::uint64_t begin = 1'000'000;
    start(stage, 3, begin);
    const auto jumped = [](std::uint64_t k) {
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(k) + GetParam());
    };
    int with_all_of_the_new = 0;
    for (std::uint64_t k = begin + 1; k < begin + 90; ++k) {
        stage.at(k, 10ms);
        for (std::size_t rig = 0; rig < 3; ++rig) {
            const bool restarted = k >= begin + 20 * (rig + 1);
            stage.frame(rig, restarted ? jumped(k) : k, restarted ? 2 : 1);
        }
        for (const FrameSet& set : stage.closed()) {
            const bool is_new = set.trigger_index == jumped(k);
            with_all_of_the_new += is_new && set.present() == 3;
            for (const FrameSet::Slot& slot : set.slots) {
                if (!slot.frame) continue;
                EXPECT_EQ(slot.frame->trigger_index, set.trigger_index);
            }
        }
    }
    EXPECT_EQ(with_all_of_the_new, 30);
}

TEST_P(JumpTest, FollowsTheOnlyRig) {
    Stage stage(1);
    constexpr std::uint64_t begin = 1'000'000;
    start(stage, 1, begin);
    stage.at(begin + 3, 10ms);
    const auto index = static_cast<std::uint64_t>(begin + GetParam());
    EXPECT_EQ(stage.frame(0, index, 2), FrameFate::in_frame_set);
    EXPECT_THAT(stage.closed_indices(), ElementsAre(index));
}

INSTANTIATE_TEST_SUITE_P(Jumps, JumpTest,
                         testing::Values(-999'000, -1000, 30, 1000, std::int64_t{1} << 52));

TEST(FrameSetAssembler, TheOnlyRigIsFollowedWhenARestartTakesItBackALittle) {
    Stage stage(1);
    for (std::uint64_t k = 1; k < 30; ++k) {
        stage.at(k, 10ms);
        stage.frame(0, k, 1);
        stage.closed();
    }
    stage.at(31, 10ms);
    EXPECT_EQ(stage.frame(0, 1, 2), FrameFate::in_frame_set);
    EXPECT_THAT(stage.closed_indices(), ElementsAre(1));
}

TEST(FrameSetAssembler, UnsynchronizedFramesAreNeverJoinedWithOthers) {
    Stage stage(2);
    stage.at(1, 10ms);
    EXPECT_EQ(stage.frame(0, 1, 1, false), FrameFate::unsynchronized);
    EXPECT_EQ(stage.frame(1, 1, 1, true), FrameFate::in_frame_set);
    const auto sets = stage.closed();
    ASSERT_EQ(sets.size(), 1u);
    EXPECT_EQ(sets[0].slots[0].absence, Absence::unsynchronized);
    EXPECT_EQ(sets[0].slots[0].frame, nullptr);
}

TEST(FrameSetAssembler, ReportsARigWithoutPulsesUntilTheyReturn) {
    Stage stage(2);
    start(stage, 2, 100);
    std::uint64_t index = 101;
    for (; !stage.assembler().names_no_pulse(0) && index < 200; ++index) {
        stage.at(index, 10ms);
        EXPECT_EQ(stage.frame(0, index, 1, false), FrameFate::unsynchronized);
        stage.frame(1, index);
        EXPECT_THAT(stage.closed_indices(), ElementsAre(index)) << "it is not waited for";
    }
    EXPECT_EQ(index, 111u) << "a few may lack theirs";
    stage.at(index, 10ms);
    EXPECT_EQ(stage.frame(0, index), FrameFate::in_frame_set);
    EXPECT_FALSE(stage.assembler().names_no_pulse(0));
}

TEST(FrameSetAssembler, OnAStageOfOneRigUnsynchronizedFramesAreTakenAsTheyCome) {
    Stage stage(1);
    for (std::uint64_t k = 1; k < 4; ++k) {
        stage.at(k, 10ms);
        EXPECT_EQ(stage.frame(0, k, 1, false), FrameFate::in_frame_set);
        EXPECT_THAT(stage.closed_indices(), ElementsAre(k));
    }
}

TEST(FrameSetAssembler, EveryFrameHasExactlyOneFate) {
    Stage stage(4);
    std::mt19937_64 random(9);
    int given = 0;
    int in_closed_frame_sets = 0;
    const auto collect = [&] {
        for (const FrameSet& set : stage.closed()) in_closed_frame_sets += set.present();
    };
    for (std::uint64_t k = 10'000; k < 12'000; ++k)
        for (std::size_t rig = 0; rig < 4; ++rig) {
            const std::uint64_t wild = random();
            stage.at(k, std::chrono::milliseconds(wild % 300));
            std::uint64_t index = k;
            if (wild % 17 == 0) index -= wild % 5;
            if (wild % 101 == 0) index = random() >> 11;
            stage.frame(rig, index, 1 + (wild % 503 == 0), wild % 7 != 0);
            ++given;
            collect();
        }
    stage.pass(budget);
    collect();
    EXPECT_EQ(stage.assembler().open_frame_sets(), 0u);
    EXPECT_EQ(in_closed_frame_sets, stage.count(FrameFate::in_frame_set));
    EXPECT_EQ(given, stage.count(FrameFate::in_frame_set) + stage.count(FrameFate::late) +
                         stage.count(FrameFate::duplicate) +
                         stage.count(FrameFate::unsynchronized) +
                         stage.count(FrameFate::out_of_step));
}

std::vector<std::string> rigs_of(const FrameSet& set) {
    std::vector<std::string> names;
    for (const FrameSet::Slot& slot : set.slots) names.push_back(slot.rig);
    return names;
}

TEST(FrameSetAssembler, FollowsAChangedStageWithoutLosingAFrame) {
    Stage stage(3);
    start(stage, 3, 100);
    stage.at(101, 10ms);
    for (const std::size_t rig : {0, 2}) stage.frame(rig, 101);
    EXPECT_THAT(stage.closed(), IsEmpty());

    // Rig 0 leaves, rig 3 joins before the others, and a frame set is open.
    FrameSetAssembler& assembler = stage.assembler();
    assembler.add_rig("rig-3");
    assembler.set_connected(0, false);
    assembler.set_connected(3, true);
    assembler.set_order({3, 1, 2});
    stage.frame(3, 101);
    stage.frame(1, 101);
    const std::vector<FrameSet> across = stage.closed();
    ASSERT_EQ(across.size(), 1u);
    EXPECT_THAT(rigs_of(across[0]), ElementsAre("rig-3", "rig-1", "rig-2", "rig-0"))
        << "the frame that the removed rig had sent";
    EXPECT_EQ(across[0].present(), 4);

    stage.at(102, 10ms);
    for (const std::size_t rig : {1, 2, 3}) stage.frame(rig, 102);
    const std::vector<FrameSet> after = stage.closed();
    ASSERT_EQ(after.size(), 1u) << "nobody waits for the rig that left";
    EXPECT_THAT(rigs_of(after[0]), ElementsAre("rig-3", "rig-1", "rig-2"));
    EXPECT_EQ(stage.count(FrameFate::in_frame_set), 3 + 2 + 2 + 3);
}

TEST(FrameSetAssembler, ARigThatRunsAheadDoesNotMakeTheOthersLate) {
    Stage stage(3);
    start(stage, 3, 100);
    // Nearly as far ahead as is still in step: nearly all of the others' budget.
    constexpr std::uint64_t ahead = budget / pulse_period - 1;
    for (std::uint64_t k = 101; k < 130; ++k) {
        stage.at(k, 10ms);
        (void)stage.frame(0, k + ahead);
        (void)stage.closed();
        // Now and then the others are somewhat slower.
        stage.at(k, k % 4 == 0 ? 70ms : 30ms);
        (void)stage.closed();
        for (const std::size_t rig : {1, 2})
            EXPECT_EQ(stage.frame(rig, k), FrameFate::in_frame_set) << k;
        (void)stage.closed();
    }
}

TEST(FrameSetAssembler, ARigThatIsAloneAtTheStartCostsTheOthersNoFrame) {
    for (const std::uint64_t ahead : {0, 1, 4, 20}) {
        Stage stage(3);
        for (const std::size_t rig : {1, 2}) stage.assembler().set_coming(rig, true);
        for (std::uint64_t k = 100; k <= 105; ++k) {
            stage.at(k, 5ms);
            (void)stage.frame(0, k);
            (void)stage.frame(0, k + ahead);
            EXPECT_THAT(stage.closed(), IsEmpty()) << "the others are about to come";
        }
        for (std::uint64_t k = 105; k <= 140; ++k) {
            stage.at(k, 5ms);
            (void)stage.frame(0, k);
            (void)stage.closed();
            stage.at(k, 30ms);
            for (const std::size_t rig : {1, 2})
                EXPECT_EQ(stage.frame(rig, k), FrameFate::in_frame_set) << k << ", " << ahead;
            EXPECT_THAT(stage.closed_indices(), testing::Contains(k));
        }
    }
}

TEST(FrameSetAssembler, WaitsAtTheStartOnlyWhileOtherRigsAreAboutToCome) {
    Stage stage(3);
    for (const std::size_t rig : {1, 2}) stage.assembler().set_coming(rig, true);
    stage.assembler().set_connected(1, false);
    stage.at(100, 5ms);
    stage.frame(0, 100);
    EXPECT_THAT(stage.closed(), IsEmpty());
    stage.assembler().set_coming(2, false);
    EXPECT_THAT(stage.closed_indices(), ElementsAre(100)) << "one is off, the other one is mute";
}

TEST(FrameSetAssembler, WaitsAtTheStartForALimitedTime) {
    Stage stage(3);
    for (const std::size_t rig : {1, 2}) stage.assembler().set_coming(rig, true);
    stage.at(100, 5ms);
    stage.frame(0, 100);
    const MonotonicTime end = stage.now() + FrameSetAssembler::longest_gathering;
    EXPECT_EQ(stage.assembler().next_deadline(), end);
    stage.pass(FrameSetAssembler::longest_gathering - 1ms);
    EXPECT_THAT(stage.closed(), IsEmpty());
    stage.pass(1ms);
    EXPECT_THAT(stage.closed_indices(), ElementsAre(100));
}

TEST(FrameSetAssembler, MostRigsGiveUpTheOrderThatOneAloneSetFarAhead) {
    Stage stage(3);
    constexpr std::uint64_t ahead = budget / pulse_period + 5;
    stage.at(100, 10ms);
    (void)stage.frame(0, 100 + ahead);
    EXPECT_THAT(stage.closed_indices(), ElementsAre(100 + ahead)) << "nobody else is there";
    stage.at(101, 10ms);
    EXPECT_EQ(stage.frame(1, 101), FrameFate::late) << "one against one";
    EXPECT_EQ(stage.frame(2, 101), FrameFate::in_frame_set);
    (void)stage.closed();
    for (std::uint64_t k = 102; k < 120; ++k) {
        stage.at(k, 10ms);
        for (const std::size_t rig : {1, 2})
            EXPECT_EQ(stage.frame(rig, k), FrameFate::in_frame_set) << k;
        (void)stage.closed();
    }
}

}  // namespace
}  // namespace vantage

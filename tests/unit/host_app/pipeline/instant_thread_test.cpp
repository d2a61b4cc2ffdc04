#include "host_app/pipeline/instant_thread.h"

#include <atomic>
#include <functional>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/gl/context/context_group.h"
#include "common/gl/sliced_drawing.h"
#include "host_app/pipeline/rig_demand.h"
#include "tests/support/eventually.h"
#include "tests/support/gpu_reset.h"
#include "tests/unit/host_app/frames/scripted_feed.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

/// What a test's preparers must do, and counters of what they did.
struct Orders {
    std::atomic<bool> fails_to_take = false;
    std::atomic<bool> fails_to_prepare = false;
    std::atomic<bool> draws_next_until_released = false, is_released = false;
    std::atomic<int> made = 0, taken = 0, prepared = 0, cuts = 0, rank = 0;
    std::atomic<int> warm_ups = 0, taken_at_warm_up = 0;
    std::atomic<std::size_t> warm_up_rigs = 0, kept_rigs = 0;
    std::atomic<bool> keeps_south = false;
    std::atomic<double> warm_up_apart_m = 0;  ///< the first two of them
    std::function<void()> at_warm_up;         ///< set before the first set is pushed
    std::atomic<double> dt_s = 0;
};

class OrderedPreparer final : public InstantPreparer {
  public:
    explicit OrderedPreparer(std::shared_ptr<Orders> orders) : orders_(std::move(orders)) {
        ++orders_->made;
    }
    void take(std::span<const DepthView> views, double dt_s) override {
        if (orders_->fails_to_take) fail("the driver is lost");
        // Bounded, so that a failing test ends.
        if (orders_->draws_next_until_released.exchange(false))
            for (int i = 0; i < 5000 && !orders_->is_released; ++i) {
                SlicedDrawing::current()->give_way();
                std::this_thread::sleep_for(2ms);
            }
        // Preparing a marked image fails.
        is_marked_ = !views.empty() && views.front().colour(0, 0)[3] == 7;
        orders_->dt_s = dt_s;
        ++orders_->taken;
    }
    std::shared_ptr<const Instant> prepare(const VirtualView&, const PrepareLevel& level) override {
        if (orders_->fails_to_prepare || is_marked_) fail("the driver is lost");
        orders_->rank = level.rank;
        ++orders_->prepared;
        return std::make_shared<Instant>();
    }
    void warm_up(std::span<const DepthView> views, const VirtualView&) override {
        ++orders_->warm_ups;
        if (orders_->at_warm_up) orders_->at_warm_up();
        orders_->warm_up_rigs = views.size();
        orders_->warm_up_apart_m =
            (views[1].world_from_camera.translation() - views[0].world_from_camera.translation())
                .norm();
        orders_->taken_at_warm_up = orders_->taken.load();
    }
    void cut() override { ++orders_->cuts; }
    void keep_only(const std::set<std::string>& rigs) override {
        orders_->kept_rigs = rigs.size();
        orders_->keeps_south = rigs.contains("south");
    }

  private:
    std::shared_ptr<Orders> orders_;
    bool is_marked_ = false;
};

class InstantThreadTest : public testing::Test {
  protected:
    InstantThreadTest() { make_thread(feed_.feed()); }
    void make_thread(StageFeed feed) {
        thread_ = std::make_unique<InstantThread>(
            InstantThread::Settings{.pulse_rate_hz = 10, .replay_bytes = 100'000'000},
            std::move(feed), contexts_);
        thread_->prepare_for("ordered", [orders = orders_](const ShaderLibrary&) {
            return std::make_unique<OrderedPreparer>(orders);
        });
    }
    void push(std::uint64_t pulse) { feed_.push(feed_.set(pulse, {"north", "south"})); }
    void push_marked(std::uint64_t pulse) {
        FrameSet set = feed_.set(pulse, {"north", "south"});
        for (FrameSet::Slot& slot : set.slots) {
            auto frame = std::make_shared<RigFrame>(*slot.frame);
            frame->colour = frame->colour.clone();
            frame->colour(0, 0)[3] = 7;
            slot.frame = frame;
        }
        feed_.push(set);
    }
    void go_to(std::optional<double> pulse, std::uint64_t jumps) {
        thread_->request({.pulse = pulse, .target = {}, .level = {}, .jumps = jumps});
    }
    bool wait_for_pulse(std::uint64_t pulse) {
        return eventually([&] {
            const auto newest = thread_->newest();
            return newest && newest->set->trigger_index == pulse;
        });
    }

    ContextGroup contexts_;
    ScriptedFeed feed_{{"north", "south"}}, feed_of_six_{{"a", "b", "c", "d", "e", "f"}};
    std::shared_ptr<Orders> orders_ = std::make_shared<Orders>();
    std::unique_ptr<InstantThread> thread_;
};

TEST_F(InstantThreadTest, DescribesTheInstantsSource) {
    push(4);
    ASSERT_TRUE(wait_for_pulse(4));
    const auto first = thread_->newest();
    EXPECT_TRUE(first->is_live);
    EXPECT_EQ(first->synthesiser, "ordered");
    ASSERT_TRUE(first->exposure);
    for (const FrameSet::Slot& slot : first->set->slots)
        EXPECT_LE(*first->exposure, slot.frame->exposure);
    push(5);
    ASSERT_TRUE(wait_for_pulse(5));
    EXPECT_GT(thread_->newest()->number, first->number);
}

/// A warm-up takes seconds and forgets what was learnt, so it must be over before the show.
TEST_F(InstantThreadTest, WarmsUpWithTheFirstFrameSetThoughARigIsMissing) {
    feed_.push(feed_.set(4, {"south"}));
    ASSERT_TRUE(wait_for_pulse(4));
    EXPECT_EQ(orders_->warm_ups, 1);
    EXPECT_EQ(orders_->taken_at_warm_up, 0);
    EXPECT_EQ(orders_->warm_up_rigs, 2u) << "shaders that compare rigs are compiled too";
    EXPECT_GT(orders_->warm_up_apart_m, 0) << "rigs at the same place are not compared";
    push(5);
    ASSERT_TRUE(wait_for_pulse(5));
    EXPECT_EQ(orders_->warm_ups, 1);
}

/// Shaders differ by the number of rigs that are compared, which is limited.
TEST_F(InstantThreadTest, WarmsUpWithTheLargestNumberOfComparedRigs) {
    thread_.reset();
    make_thread(feed_of_six_.feed());
    feed_of_six_.push(feed_of_six_.set(4, {"b", "c"}));
    ASSERT_TRUE(wait_for_pulse(4));
    EXPECT_EQ(orders_->warm_up_rigs, 4u);
}

TEST_F(InstantThreadTest, BeginsWithTheFrameSetThatArrivedDuringWarmUp) {
    orders_->at_warm_up = [&] {
        for (const std::uint64_t pulse : {5, 6}) push(pulse);
        ASSERT_TRUE(eventually([&] { return thread_->stats().replaced.sets == 1; }));
    };
    push(4);
    ASSERT_TRUE(wait_for_pulse(6));
    EXPECT_EQ(orders_->prepared, 1);
    EXPECT_EQ(thread_->stats().replaced.sets, 2u);
    EXPECT_EQ(thread_->stats().replaced.frames.at("north"), 2u);
}

TEST_F(InstantThreadTest, PreparesRequestedMomentsBetweenPulses) {
    for (const std::uint64_t pulse : {4, 5, 6}) {
        push(pulse);
        ASSERT_TRUE(wait_for_pulse(pulse));
    }
    const auto shows = [&](double pulse, int moments, std::uint64_t wanted, double share) {
        thread_->request({.pulse = pulse, .moments_per_pulse = moments, .target = {}, .level = {}});
        return eventually([&] {
            const auto newest = thread_->newest();
            return newest->set->trigger_index == wanted && newest->share == share;
        });
    };
    EXPECT_TRUE(shows(4.05, 4, 4, 0)) << "filmed frames take precedence";
    EXPECT_TRUE(shows(4.375, 4, 4, 0.375));
    EXPECT_NEAR(orders_->dt_s, 0.0375, 1e-9);
    EXPECT_TRUE(shows(4.75, 4, 4, 0.75));
    EXPECT_TRUE(shows(5.0, 4, 5, 0));
    EXPECT_NEAR(orders_->dt_s, 0.025, 1e-9);
    const std::uint64_t shown = thread_->newest()->number;
    EXPECT_TRUE(shows(5.125, 4, 5, 0)) << "less than a moment later";
    EXPECT_TRUE(shows(5.5, 1, 5, 0));
    EXPECT_EQ(thread_->newest()->number, shown);
    EXPECT_TRUE(shows(6.5, 4, 6, 0.5)) << "there is no next one";
    EXPECT_EQ(thread_->stats().between, 3u);
    EXPECT_EQ(thread_->stats().prepared, 3u) << "the past was counted when it was live";
}

TEST_F(InstantThreadTest, PassesThePreparerTheTimeBetweenFrameSets) {
    push(4);
    ASSERT_TRUE(wait_for_pulse(4));
    const int cuts = orders_->cuts;
    push(7);
    ASSERT_TRUE(wait_for_pulse(7));
    EXPECT_NEAR(orders_->dt_s, 0.3, 1e-9);
    EXPECT_EQ(orders_->cuts, cuts);
    push(100);
    ASSERT_TRUE(wait_for_pulse(100));
    EXPECT_EQ(orders_->cuts, cuts + 1) << "nothing is tracked across nine seconds";
    push(2);
    ASSERT_TRUE(wait_for_pulse(2));
    EXPECT_EQ(orders_->cuts, cuts + 2) << "the stage was restarted";
}

TEST_F(InstantThreadTest, AJumpInTimeCancelsPlayback) {
    for (const std::uint64_t pulse : {1, 2, 3}) {
        push(pulse);
        ASSERT_TRUE(wait_for_pulse(pulse));
    }
    const auto draw_until_the_jump = [&](std::optional<double> pulse, std::uint64_t jumps) {
        orders_->draws_next_until_released = true;
        go_to(pulse, jumps);
        if (!pulse) push(4);
        return eventually([&] { return !orders_->draws_next_until_released; });
    };
    go_to(1, 1);
    ASSERT_TRUE(wait_for_pulse(1));
    ASSERT_TRUE(draw_until_the_jump(2, 1));
    int prepared = orders_->prepared;
    go_to(3, 2);
    ASSERT_TRUE(wait_for_pulse(3));
    EXPECT_EQ(orders_->prepared, prepared + 1);
    // The preparer holds a part of the cancelled frame set, so the shown one is taken again.
    const int taken = orders_->taken;
    ASSERT_TRUE(draw_until_the_jump(2, 2));
    go_to(3, 3);
    ASSERT_TRUE(eventually([&] { return orders_->taken == taken + 1; }));
    // A live one that is given up is counted.
    const std::uint64_t replaced = thread_->stats().replaced.sets;
    ASSERT_TRUE(draw_until_the_jump(std::nullopt, 3));
    prepared = orders_->prepared;
    go_to(1, 4);
    ASSERT_TRUE(wait_for_pulse(1));
    EXPECT_EQ(orders_->prepared, prepared + 1);
    EXPECT_EQ(thread_->stats().replaced.sets, replaced + 1);
    EXPECT_EQ(thread_->stats().faults, 0);
}

TEST_F(InstantThreadTest, FinishesTheTargetOfAJumpSoThatAJogShowsIt) {
    for (const std::uint64_t pulse : {1, 2, 3}) {
        push(pulse);
        ASSERT_TRUE(wait_for_pulse(pulse));
    }
    const int prepared = orders_->prepared;
    orders_->draws_next_until_released = true;
    go_to(2, 1);
    ASSERT_TRUE(eventually([&] { return !orders_->draws_next_until_released; }));
    go_to(1, 2);
    std::this_thread::sleep_for(50ms);
    orders_->is_released = true;
    ASSERT_TRUE(wait_for_pulse(1));
    EXPECT_EQ(orders_->prepared, prepared + 2);
}

TEST_F(InstantThreadTest, RefinesTheShownInstantWhileHeldAndTakesNoNewOne) {
    thread_->request({.pulse = {}, .target = {}, .level = prepare_levels()[2]});
    push(1);
    ASSERT_TRUE(eventually([&] { return orders_->prepared > 0; }));
    ASSERT_TRUE(wait_for_pulse(1));
    const auto before = thread_->newest();
    thread_->request({.pulse = {}, .is_held = true, .target = {}, .level = prepare_levels()[0]});
    ASSERT_TRUE(eventually([&] { return thread_->newest()->number > before->number; }));
    EXPECT_EQ(orders_->rank, 0);
    EXPECT_EQ(thread_->newest()->set, before->set);
    const int prepared = orders_->prepared;
    push(2);
    ASSERT_TRUE(eventually([&] { return feed_.drained(); }));
    std::this_thread::sleep_for(300ms);
    EXPECT_EQ(thread_->newest()->set, before->set);
    EXPECT_EQ(orders_->prepared, prepared) << "no better instant is requested";
    thread_->request({.pulse = {}, .target = {}, .level = {}});
    EXPECT_TRUE(wait_for_pulse(2));
}

TEST_F(InstantThreadTest, TakesThePastFromTheReplayBufferAndCountsItOnce) {
    for (const std::uint64_t pulse : {1, 2, 3}) {
        push(pulse);
        ASSERT_TRUE(wait_for_pulse(pulse));
    }
    thread_->request({.pulse = 1.7, .target = {}, .level = {}});
    ASSERT_TRUE(wait_for_pulse(1));
    EXPECT_FALSE(thread_->newest()->is_live);
    EXPECT_EQ(thread_->stats().prepared, 3u);
}

TEST_F(InstantThreadTest, StopsNoRigWhileHeldOrInThePast) {
    ScriptedFeed many{{"1", "2", "3", "4", "5", "6"}};
    StageFeed feed = many.feed();
    std::atomic<int> asks = 0;
    feed.ask = [&](const std::string&, bool) { ++asks; };
    InstantThread thread({.pulse_rate_hz = 10, .replay_bytes = 100'000'000}, feed, contexts_);
    thread.prepare_for("ordered", [this](const ShaderLibrary&) {
        return std::make_unique<OrderedPreparer>(orders_);
    });
    InstantRequest request;
    request.target.width_px = 64;
    request.target.height_px = 48;
    request.target.K << 40, 0, 31.5, 0, 40, 23.5, 0, 0, 1;
    request.target.world_from_camera = look_at({0, 1, 4.5}, {0, 1, 0});
    const auto shows = [&](std::uint64_t pulse) {
        return eventually([&] {
            const auto newest = thread.newest();
            return newest && newest->set->trigger_index == pulse;
        });
    };
    const auto push_all = [&](std::uint64_t pulse) {
        many.push(many.set(pulse, {"1", "2", "3", "4", "5", "6"}));
    };
    thread.request(request);
    for (const std::uint64_t pulse : {1, 2}) {
        push_all(pulse);
        ASSERT_TRUE(shows(pulse));
    }
    // The camera does not need the sixth rig, which would be asked to stop after a while.
    static_assert(RigDemand::most_rigs == 5);
    request.is_held = true;
    thread.request(request);
    push_all(3);
    std::this_thread::sleep_for(RigDemand::hold + 100ms);
    request.is_held = false;
    for (const double pulse : {1, 2, 1}) {
        request.pulse = pulse;
        thread.request(request);
        ASSERT_TRUE(shows(static_cast<std::uint64_t>(pulse)));
    }
    EXPECT_EQ(asks, 0);
    request.pulse.reset();
    thread.request(request);
    push_all(4);
    EXPECT_TRUE(eventually([&] { return asks == 1; })) << "live, the sixth rig is stopped";
}

TEST_F(InstantThreadTest, RecoversFromAPreparerThatFails) {
    push(1);
    ASSERT_TRUE(wait_for_pulse(1));
    orders_->fails_to_take = true;
    push(2);
    ASSERT_TRUE(eventually([&] { return thread_->stats().faults >= 2; })) << "it retries";
    EXPECT_EQ(thread_->newest()->set->trigger_index, 1u) << "the last instant stays available";
    orders_->fails_to_take = false;
    push(3);
    EXPECT_TRUE(wait_for_pulse(3));
    EXPECT_GE(orders_->made, 3);
}

TEST_F(InstantThreadTest, KeepsThePreparersOfEarlierSynthesisers) {
    push(4);
    ASSERT_TRUE(wait_for_pulse(4));
    const auto change_to = [&](const std::string& synthesiser, std::shared_ptr<Orders> orders) {
        thread_->prepare_for(synthesiser, [orders](const ShaderLibrary&) {
            return std::make_unique<OrderedPreparer>(orders);
        });
        return eventually([&] { return thread_->newest()->synthesiser == synthesiser; });
    };
    const auto others = std::make_shared<Orders>();
    ASSERT_TRUE(change_to("other", others));
    const int cuts = orders_->cuts;
    ASSERT_TRUE(change_to("ordered", orders_));
    ASSERT_TRUE(change_to("other", others));
    EXPECT_EQ(orders_->made, 1);
    EXPECT_EQ(others->made, 1);
    EXPECT_EQ(orders_->cuts, cuts + 1) << "it did not see what moved meanwhile";
}

TEST_F(InstantThreadTest, PreparesTheShownInstantAnewAfterAGpuReset) {
    push(1);
    ASSERT_TRUE(wait_for_pulse(1));
    const auto before = thread_->newest();
    reset_gpu();
    // The loss is noticed with the next frame set, which counts as not prepared.
    push(2);
    ASSERT_TRUE(eventually([&] { return thread_->newest()->generation > before->generation; }));
    EXPECT_EQ(contexts_.losses(), 1);
    EXPECT_EQ(thread_->newest()->set->trigger_index, 1u)
        << "the shown frame set is prepared at once";
    push(3);
    ASSERT_TRUE(wait_for_pulse(3));
    EXPECT_EQ(contexts_.losses(), 1);
    EXPECT_EQ(thread_->stats().faults, 1);
    EXPECT_EQ(thread_->close().sets, 3u);
    EXPECT_EQ(thread_->stats().prepared + thread_->stats().replaced.sets, 3u);
}

TEST_F(InstantThreadTest, ContinuesAfterAFrameSetThatCannotBePrepared) {
    push(1);
    ASSERT_TRUE(wait_for_pulse(1));
    push_marked(2);
    ASSERT_TRUE(eventually([&] { return thread_->stats().faults >= 1; }));
    push(3);
    EXPECT_TRUE(wait_for_pulse(3));
    EXPECT_EQ(thread_->stats().faults, 1) << "it is not retried";
}

TEST_F(InstantThreadTest, RecoversFromAFaultDespiteAJumpInTime) {
    push(1);
    ASSERT_TRUE(wait_for_pulse(1));
    push_marked(2);
    ASSERT_TRUE(eventually([&] { return thread_->stats().faults >= 1; }));
    orders_->draws_next_until_released = true;
    go_to(std::nullopt, 1);
    push(3);
    ASSERT_TRUE(eventually([&] { return !orders_->draws_next_until_released; }));
    orders_->is_released = true;
    EXPECT_TRUE(wait_for_pulse(3));
    EXPECT_EQ(thread_->stats().faults, 1);
}

TEST_F(InstantThreadTest, CountsEveryFrameSetOnceAlsoThoseThatFail) {
    push(1);
    ASSERT_TRUE(wait_for_pulse(1));
    push_marked(2);
    ASSERT_TRUE(eventually([&] { return thread_->stats().faults >= 1; }));
    orders_->fails_to_take = true;
    push(3);
    ASSERT_TRUE(eventually([&] { return thread_->stats().faults >= 3; }));
    orders_->fails_to_take = false;
    push(4);
    ASSERT_TRUE(wait_for_pulse(4));
    EXPECT_EQ(thread_->close().sets, 4u);
    const InstantThread::Stats stats = thread_->stats();
    EXPECT_EQ(stats.prepared + stats.replaced.sets, 4u);
    for (const char* rig : {"north", "south"})
        EXPECT_EQ(stats.frames.at(rig) + stats.replaced.frames.at(rig), 4u);
}

TEST_F(InstantThreadTest, RethrowsWhatTheFeedThrew) {
    feed_.fail_with("the receiver broke");
    EXPECT_TRUE(eventually([&] {
        try {
            thread_->newest();
            return false;
        } catch (const Error& error) {
            return std::string(error.what()) == "the receiver broke";
        }
    }));
}

TEST_F(InstantThreadTest, ForgetsTheRigsThatTheStageHasNoLonger) {
    FrameSet without_frame = feed_.set(1, {"north"});
    feed_.push(without_frame);
    ASSERT_TRUE(wait_for_pulse(1));
    EXPECT_EQ(orders_->kept_rigs, 2u);
    EXPECT_TRUE(orders_->keeps_south) << "its frame alone is missing";
    FrameSet without_slot = feed_.set(2, {"north"});
    without_slot.slots.pop_back();
    feed_.push(without_slot);
    ASSERT_TRUE(wait_for_pulse(2));
    EXPECT_EQ(orders_->kept_rigs, 1u);
    EXPECT_FALSE(orders_->keeps_south);
    go_to(1, 1);
    ASSERT_TRUE(wait_for_pulse(1));
    EXPECT_EQ(orders_->kept_rigs, 1u) << "the past says nothing about the stage of now";
}

TEST_F(InstantThreadTest, InstantsOutliveTheThread) {
    push(1);
    ASSERT_TRUE(wait_for_pulse(1));
    const auto kept = thread_->newest();
    thread_.reset();
    EXPECT_EQ(kept->set->trigger_index, 1u);
}

}  // namespace
}  // namespace vantage

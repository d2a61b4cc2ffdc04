#include "host_app/output/output.h"

#include <mutex>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/unit/host_app/output/given_pictures.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

/// A target that does as the test says, and what it was given.
struct Script {
    std::mutex mutex;
    std::vector<std::int64_t> ticks;
    std::vector<int> levels;
    int opened = 0, finished = 0, destroyed = 0;
    bool refuses = false, breaks = false, hangs = false;

    std::size_t count() {
        const std::lock_guard lock(mutex);
        return ticks.size();
    }
    template <class Change>
    void set(Change change) {
        const std::lock_guard lock(mutex);
        change(*this);
    }
};

class ScriptedTarget final : public OutputTarget {
  public:
    ScriptedTarget(std::shared_ptr<Script> script, const OutputPatience& patience)
        : script_(std::move(script)), patience_(patience) {}
    ~ScriptedTarget() override {
        script_->set([](Script& script) { ++script.destroyed; });
    }
    void write(const ColourImage& picture, std::int64_t tick, const std::string&) override {
        for (;;) {
            {
                const std::lock_guard lock(script_->mutex);
                if (script_->breaks) fail("the line is broken");
                if (!script_->hangs) break;
            }
            if (patience_.is_over()) fail("nobody took it in time");
            std::this_thread::sleep_for(1ms);
        }
        const std::lock_guard lock(script_->mutex);
        script_->ticks.push_back(tick);
        script_->levels.push_back(picture(0, 0)[0]);
    }
    void finish() override {
        script_->set([](Script& script) { ++script.finished; });
    }
    std::string salvage() override { return "; what came is kept"; }
    std::uint64_t bytes() const override { return 1000; }

  private:
    std::shared_ptr<Script> script_;
    const OutputPatience& patience_;
};

class OutputTest : public testing::Test {
  protected:
    Output& make(bool is_stream) {
        OutputPlan plan;
        plan.name = "line";
        plan.is_stream = is_stream;
        plan.is_encoded = false;
        plan.open = [script = script_](const OutputPatience& patience) {
            const std::lock_guard lock(script->mutex);
            if (script->refuses) fail("nobody is there");
            ++script->opened;
            return std::make_unique<ScriptedTarget>(script, patience);
        };
        output_.emplace(std::move(plan), OutputFormat{}, 30);
        return *output_;
    }
    OutputPhase phase() const { return output_->state().phase; }
    bool wait_for_phase(OutputPhase wanted) {
        return wait_for([&] { return phase() == wanted; });
    }
    /// So many pictures, of which none is left out.
    void give(std::uint64_t from, std::uint64_t count) {
        for (std::uint64_t i = 0; i < count; ++i) {
            ASSERT_TRUE(wait_for([&] { return output_->state().queued < 8; }));
            output_->take(given_picture(from + i, static_cast<int>(from + i)));
        }
    }
    /// Nothing is under way any more.
    void expect_stats_that_add_up() {
        const OutputState state = output_->state();
        EXPECT_EQ(state.offered, state.pictures + state.dropped + state.unheard);
        EXPECT_EQ(state.pictures, script_->count());
    }

    std::shared_ptr<Script> script_ = std::make_shared<Script>();
    std::optional<Output> output_;
};

TEST_F(OutputTest, WritesEveryPictureInItsOrderAndEndsWell) {
    make(false).start();
    give(5, 40);
    output_->finish();
    ASSERT_EQ(script_->count(), 40u);
    for (int i = 0; i < 40; ++i) {
        EXPECT_EQ(script_->ticks[static_cast<std::size_t>(i)], i) << "counted from its first";
        EXPECT_EQ(script_->levels[static_cast<std::size_t>(i)], 5 + i) << "the clean picture";
    }
    EXPECT_EQ(script_->finished, 1);
    EXPECT_EQ(phase(), OutputPhase::off);
    EXPECT_EQ(output_->state().pictures, 40u);
    EXPECT_EQ(output_->state().dropped, 0u);
    expect_stats_that_add_up();
}

TEST_F(OutputTest, OneThatHangsHoldsNobodyUpAndLeavesTheOldestOut) {
    script_->hangs = true;
    make(true).start();
    ASSERT_TRUE(wait_for_phase(OutputPhase::on));
    for (std::uint64_t tick = 0; tick < 100; ++tick)
        output_->take(given_picture(tick, static_cast<int>(tick)));
    EXPECT_EQ(output_->state().dropped + output_->state().queued, 100u);
    EXPECT_GE(output_->state().dropped, 90u);
    script_->set([](Script& script) { script.hangs = false; });
    ASSERT_TRUE(wait_for([&] { return output_->state().queued == 0; }));
    EXPECT_EQ(script_->levels.back(), 99) << "the newest is never the one left out";
    expect_stats_that_add_up();
}

TEST_F(OutputTest, EndsInTimeThoughItsPeerHangs) {
    script_->hangs = true;
    make(true).start();
    ASSERT_TRUE(wait_for_phase(OutputPhase::on));
    for (std::uint64_t tick = 0; tick < 3; ++tick) output_->take(given_picture(tick));
    output_->finish();
    EXPECT_EQ(phase(), OutputPhase::failed);
    EXPECT_EQ(output_->state().failure, "nobody took it in time; what came is kept");
    expect_stats_that_add_up();
}

TEST_F(OutputTest, AFilmThatFailsStaysFailedAndSaysWhatIsKept) {
    make(false).start();
    give(0, 5);
    ASSERT_TRUE(wait_for([&] { return script_->count() == 5; }));
    script_->set([](Script& script) { script.breaks = true; });
    output_->take(given_picture(5));
    ASSERT_TRUE(wait_for_phase(OutputPhase::failed));
    EXPECT_EQ(output_->state().failure, "the line is broken; what came is kept");
    script_->set([](Script& script) { script.breaks = false; });
    output_->take(given_picture(6));
    output_->finish();
    EXPECT_EQ(script_->opened, 1);
    EXPECT_EQ(script_->finished, 0);
    EXPECT_EQ(output_->state().failures, 1u);
    EXPECT_EQ(output_->state().offered, 6u) << "nothing is offered to what has ended";
    expect_stats_that_add_up();
}

TEST_F(OutputTest, AStreamIsTriedAgainUntilItsPeerIsThere) {
    script_->refuses = true;
    make(true).start();
    ASSERT_TRUE(wait_for_phase(OutputPhase::failed));
    EXPECT_EQ(output_->state().failure, "nobody is there");
    output_->take(given_picture(0));
    EXPECT_EQ(output_->state().unheard, 1u);
    script_->set([](Script& script) { script.refuses = false; });
    ASSERT_TRUE(wait_for_phase(OutputPhase::on));
    EXPECT_EQ(output_->state().failure, "");
    give(1, 3);
    ASSERT_TRUE(wait_for([&] { return script_->count() == 3; }));
    EXPECT_EQ(script_->ticks.front(), 0);
    script_->set([](Script& script) { script.breaks = true; });
    output_->take(given_picture(4));
    ASSERT_TRUE(wait_for_phase(OutputPhase::failed));
    script_->set([](Script& script) { script.breaks = false; });
    ASSERT_TRUE(wait_for_phase(OutputPhase::on));
    EXPECT_EQ(script_->opened, 2);
    EXPECT_GE(output_->state().failures, 2u);
    output_->finish();
    expect_stats_that_add_up();
}

TEST_F(OutputTest, WritesWhatItWasGivenThoughItIsEndedAtOnce) {
    make(false).start();
    for (std::uint64_t tick = 0; tick < 3; ++tick) output_->take(given_picture(tick));
    output_->finish();
    EXPECT_EQ(script_->count(), 3u);
    EXPECT_EQ(script_->finished, 1);
    expect_stats_that_add_up();
}

TEST_F(OutputTest, IsEndedAndBegunAgainWhileLive) {
    make(true);
    output_->take(given_picture(0));
    EXPECT_EQ(phase(), OutputPhase::off);
    EXPECT_EQ(output_->state().offered, 0u) << "it was not begun";
    output_->start();
    ASSERT_TRUE(wait_for_phase(OutputPhase::on));
    give(1, 3);
    output_->stop();
    ASSERT_TRUE(wait_for_phase(OutputPhase::off));
    EXPECT_EQ(script_->count(), 3u) << "what waited is written";
    EXPECT_EQ(script_->finished, 1);
    output_->take(given_picture(4));
    output_->start();
    ASSERT_TRUE(wait_for_phase(OutputPhase::on));
    give(7, 2);
    output_->finish();
    ASSERT_EQ(script_->count(), 5u);
    EXPECT_EQ(script_->ticks[3], 0) << "a time of its own";
    EXPECT_EQ(script_->finished, 2);
    expect_stats_that_add_up();
}

TEST_F(OutputTest, WhoEndsWhatFailsIsNotToldOfItAgain) {
    script_->refuses = true;
    make(true).start();
    ASSERT_TRUE(wait_for_phase(OutputPhase::failed));
    output_->stop();
    EXPECT_EQ(phase(), OutputPhase::off);
    output_->finish();
    EXPECT_EQ(phase(), OutputPhase::off);
    EXPECT_EQ(output_->state().failure, "");
    EXPECT_EQ(output_->state().failures, 1u);
}

TEST_F(OutputTest, WhatFailsAtTheEndHasFailed) {
    script_->refuses = true;
    make(true).start();
    ASSERT_TRUE(wait_for_phase(OutputPhase::failed));
    output_->finish();
    EXPECT_EQ(phase(), OutputPhase::failed);
    EXPECT_EQ(output_->state().failure, "nobody is there");
}

TEST_F(OutputTest, EndsNothingWellThatIsAbandoned) {
    make(false).start();
    give(0, 3);
    output_.reset();
    EXPECT_EQ(script_->finished, 0);
    EXPECT_EQ(script_->destroyed, script_->opened);
}

}  // namespace
}  // namespace vantage

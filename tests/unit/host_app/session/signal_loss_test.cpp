#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "host_app/desk/feed/desk_feed.h"
#include "host_app/session/report/live_report.h"
#include "host_app/session/report/show_log.h"
#include "tests/support/eventually.h"
#include "tests/unit/host_app/frames/scripted_feed.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

/// A show whose rigs send frames until the test stops them.
class SignalLoss : public testing::Test {
  protected:
    SignalLoss() {
        plan_.start = OrbitView{.distance_m = 4.5, .field_of_view_rad = 1.0};
        show_ = std::make_unique<LiveShow>(settings_, plan_, feed_.feed(), nullptr);
        context_.emplace();
    }
    void SetUp() override {
        feed_.push(feed_.set(1, {"north", "south"}));
        ASSERT_TRUE(show_->wait_for_rigs(30s, stop_));
        show_->start();
    }
    /// Waits for a condition; meanwhile the rigs send frames until the test stops them.
    bool eventually(const std::function<bool()>& condition) {
        return vantage::eventually(
            [&] {
                if (condition()) return true;
                if (goes_on_) feed_.push(feed_.set(++pulse_, {"north", "south"}));
                return false;
            },
            longest_wait, 40ms);
    }
    DeskState desk() {
        const ProgrammeState programme = show_->state();
        desk_feed_.note_shown(programme);
        return desk_feed_.state(*show_, programme, std::nullopt, "", false);
    }

    StopSignal stop_;
    ScriptedFeed feed_{{"north", "south"}};
    FlightPlan plan_;
    LiveSettings settings_{.format = {.width_px = 64, .height_px = 48},
                           .rate_hz = 25,
                           .pulse_rate_hz = 25,
                           .synthesiser = "mesh",
                           .quality = {},
                           .contact_sheet = {}};
    std::unique_ptr<LiveShow> show_;
    std::optional<EglContext> context_;
    DeskFeed desk_feed_;
    bool goes_on_ = true;
    std::uint64_t pulse_ = 1;
};

class NoPictureYet : public SignalLoss {
    void SetUp() override { feed_.push(feed_.set(1, {"north", "south"})); }
};

TEST_F(NoPictureYet, IsExplainedByTheRendererInTheLog) {
    ASSERT_TRUE(show_->wait_for_rigs(30s, stop_));
    EXPECT_EQ(ProgressLog(plan_).line(*show_),
              "no picture yet: the renderer compiles its shaders, 2 of 2 rigs send frames");
    EXPECT_TRUE(desk().has_frame_sets);
}

class NoFrameYet : public SignalLoss {
    void SetUp() override {}
};

TEST_F(NoFrameYet, IsExplainedByTheRigsInTheLog) {
    EXPECT_EQ(ProgressLog(plan_).line(*show_), "no picture yet: no rig has sent a frame");
    const DeskState state = desk();
    EXPECT_TRUE(state.waiting);
    EXPECT_FALSE(state.has_frame_sets);
    for (const DeskRig& rig : state.rigs) EXPECT_EQ(rig.state, RigState::starting) << rig.name;
}

TEST_F(SignalLoss, ReplacesTheLatencyInTheLog) {
    ProgressLog log(plan_);
    ASSERT_TRUE(eventually([&] { return show_->state().latency_ms > 0; }));
    std::string line;
    ASSERT_TRUE(eventually([&] {
        line = log.line(*show_);
        return line.find("ms from exposure to picture") != std::string::npos;
    })) << line;
    EXPECT_THAT(line, HasSubstr("2 of 2 rigs, "));
    goes_on_ = false;
    for (const char* word : {"2 of 2 rigs, STALE, levels", "2 of 2 rigs, NO SIGNAL, levels"}) {
        ASSERT_TRUE(eventually([&] {
            line = log.line(*show_);
            return line.find(word) != std::string::npos;
        })) << line;
        EXPECT_THAT(line, Not(HasSubstr("exposure")));
    }
}

TEST_F(SignalLoss, RemovesLatencyAndCoverageFromTheDesk) {
    DeskState state;
    ASSERT_TRUE(eventually([&] {
        state = desk();
        return state.signal == SignalState::live && state.latency_ms > 0 && state.coverage;
    }));
    goes_on_ = false;
    ASSERT_TRUE(eventually([&] {
        state = desk();
        return state.signal == SignalState::no_signal;
    }));
    EXPECT_EQ(state.latency_ms, 0);
    EXPECT_FALSE(state.coverage);
    EXPECT_FALSE(state.latencies_ms.empty()) << "the earlier latencies stay";
}

TEST_F(SignalLoss, AfterTheEndIsNotInTheReport) {
    ASSERT_TRUE(eventually([&] { return show_->state().picture != nullptr; }));
    feed_.push(feed_.set(++pulse_, {"north", "south"}));
    show_->finish();
    std::this_thread::sleep_for(40ms + stale_after);
    EXPECT_EQ(show_->report().signal, SignalState::live);
}

}  // namespace
}  // namespace vantage

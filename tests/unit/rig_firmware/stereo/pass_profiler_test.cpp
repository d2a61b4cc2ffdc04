#include "rig_firmware/stereo/pass_profiler.h"

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"

namespace vantage {
namespace {

TEST(PassProfiler, RunsEveryPassAndReportsNothingWhileSwitchedOff) {
    const EglContext context;
    PassProfiler profiler;
    int runs = 0;
    profiler.begin_frame();
    profiler.run("cost", {100, 5}, [&] { ++runs; });
    profiler.end_frame();
    EXPECT_EQ(runs, 1);
    EXPECT_TRUE(profiler.reports().empty());
}

TEST(PassProfiler, SumsTheRunsOfOneNameInTheOrderOfTheirFirstRunAndForgetsTheLastFrame) {
    const EglContext context;
    PassProfiler profiler;
    profiler.set_enabled(true);
    for (int frame = 0; frame < 2; ++frame) {
        profiler.begin_frame();
        profiler.run("cost", {100, 5}, [] {});
        for (int i = 0; i < 3; ++i) profiler.run("aggregate", {10, 2}, [] {});
        profiler.run("cost", {1, 1}, [] {});
        profiler.end_frame();
    }
    const std::vector<PassReport>& reports = profiler.reports();
    ASSERT_EQ(reports.size(), 2u);
    EXPECT_EQ(reports[0].name, "cost");
    EXPECT_EQ(reports[0].runs, 2);
    EXPECT_EQ(reports[0].bytes_moved, 101u);
    EXPECT_EQ(reports[0].operations, 6);
    EXPECT_EQ(reports[1].name, "aggregate");
    EXPECT_EQ(reports[1].runs, 3);
    EXPECT_EQ(reports[1].bytes_moved, 30u);
    EXPECT_GE(reports[0].gpu_ms, 0);
}

}  // namespace
}  // namespace vantage

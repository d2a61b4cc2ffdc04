#include <csignal>
#include <functional>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/processes/live/camera_on_air.h"
#include "tests/processes/live/steered_show.h"
#include "tests/support/free_ports.h"
#include "tests/support/source_folder.h"

namespace vantage {
namespace {

TEST(Preview, IsFlownWhileTheProgrammeHoldsUntilACutOrAFlight) {
    const TemporaryFolder folder;
    const int port = two_free_ports().first;
    CameraOnAir on_air(port);
    SteeredShow steered({"play", (source_folder() / "tests/takes/version_1.mkv").string(),
                         "--headless", "--size", "96x72", "--loop", "--free-flight", "--seconds",
                         "600", "--json", "--output", fmt::format("freed://127.0.0.1:{}", port)},
                        folder);
    ASSERT_TRUE(steered.shows("speed", "1")) << steered.told() << steered.show().err();
    ASSERT_TRUE(steered.shows("preview_camera", "0"));
    const Pose first = on_air.newest();
    ASSERT_TRUE(steered.send("/vantage/preview"));
    ASSERT_TRUE(steered.shows("preview_camera", "1")) << steered.told();
    ASSERT_TRUE(steered.send("/vantage/orbit f 40.0"));
    ASSERT_TRUE(steered.send("/vantage/source_map"));
    ASSERT_TRUE(steered.shows("source_map", "1")) << "the turn was taken in a step before";
    for (int ticks = 0; ticks < 50; ++ticks)
        ASSERT_LT(way_m(on_air.next(), first), 1e-4) << "tick " << ticks;

    ASSERT_TRUE(steered.send("/vantage/cut"));
    Pose second = on_air.next();
    for (int ticks = 0; ticks < 1500 && way_m(second, first) < 1e-4; ++ticks)
        second = on_air.next();
    EXPECT_GT(way_m(second, first), 0.5) << "at once";
    for (int ticks = 0; ticks < 10; ++ticks) EXPECT_LT(way_m(on_air.next(), second), 1e-4);

    ASSERT_TRUE(steered.send("/vantage/auto_time i 30"));
    ASSERT_TRUE(steered.shows("auto_time", "3"));
    ASSERT_TRUE(steered.send("/vantage/auto"));
    int between = 0;
    double nearest_m = way_m(second, first);
    for (int ticks = 0; ticks < 1500 && nearest_m > 1e-4; ++ticks) {
        const double here_m = way_m(on_air.next(), first);
        EXPECT_LE(here_m, nearest_m + 1e-4) << "straight there";
        between += here_m < nearest_m - 1e-4 && here_m > 1e-4;
        nearest_m = here_m;
    }
    EXPECT_LT(nearest_m, 1e-4) << "it is where the programme's camera was first";
    EXPECT_GT(between, 5) << "and flew there";
    EXPECT_TRUE(steered.shows("auto", "-1"));
    ASSERT_TRUE(steered.send("/vantage/preview"));
    EXPECT_TRUE(steered.shows("preview_camera", "0"));

    steered.show().send_signal(SIGINT);
    const ProgramResult end = steered.show().wait();
    const nlohmann::json summary = nlohmann::json::parse(end.out);
    EXPECT_GT(summary["preview"]["pictures"], 0) << summary;
}

}  // namespace
}  // namespace vantage

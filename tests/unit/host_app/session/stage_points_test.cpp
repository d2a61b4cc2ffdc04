#include "host_app/desk/feed/stage_points.h"

#include <gtest/gtest.h>

#include "tests/unit/host_app/frames/scripted_feed.h"

namespace vantage {
namespace {

TEST(StagePoints, AreSomeThousandOnTheSurfacesThatRigsSeeInTheirColours) {
    ScriptedFeed feed({"north", "south"});
    const FrameSet set = feed.set(1, {"north", "south"}, {200, 100, 50, 255});
    const std::vector<DeskPlan::Point> points = stage_points(set);
    ASSERT_GT(points.size(), 500u);
    EXPECT_LE(points.size(), 4000u);
    std::size_t of_the_wall = 0;
    for (const DeskPlan::Point& point : points) {
        ASSERT_TRUE(point.at_m.allFinite());
        of_the_wall += point.rgb == std::array<unsigned char, 3>{200, 100, 50};
    }
    EXPECT_GT(of_the_wall, points.size() / 3) << "the rest is black";
    EXPECT_TRUE(stage_points(feed.set(2, {})).empty());
}

}  // namespace
}  // namespace vantage

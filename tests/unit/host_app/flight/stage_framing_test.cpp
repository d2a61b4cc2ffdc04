#include <gtest/gtest.h>

#include "host_app/flight/orbit_view.h"

namespace vantage {
namespace {

FramedRig rig_at(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& target_m, double depth_m) {
    return {"rig", look_at(eye_m, target_m), 1.0, depth_m};
}

TEST(StageFraming, StartsAtTheMiddleRigWithThePivotWhereTheAxesMeet) {
    const Eigen::Vector3d middle(2, 1, 3);
    const FramedRig rigs[] = {rig_at({-2, 1.5, 7}, middle, 5.5), rig_at({2, 1.5, 8}, middle, 4),
                              rig_at({6, 1.5, 7}, middle, 6)};
    const auto framing = frame_stage(rigs);
    ASSERT_TRUE(framing);
    EXPECT_TRUE(framing->start.eye_m().isApprox(Eigen::Vector3d(2, 1.5, 8), 1e-9));
    EXPECT_TRUE(framing->start.pivot_m.isApprox(middle, 1e-6)) << framing->start.pivot_m;
    EXPECT_EQ(framing->start.field_of_view_rad, 1.0);
}

TEST(StageFraming, PutsThePivotAtTheMedianDepthOfASingleRig) {
    const FramedRig rig = rig_at({0, 1.6, 0}, {0, 1.6, -1}, 2.5);
    const auto framing = frame_stage({&rig, 1});
    ASSERT_TRUE(framing);
    EXPECT_TRUE(framing->start.pivot_m.isApprox(Eigen::Vector3d(0, 1.6, -2.5), 1e-9));
}

TEST(StageFraming, StartIsWithinTheLimits) {
    // A table top of 0.5 m, a stage of 100 m, and rigs that stand below y = 0.
    for (const FramedRig& rig :
         {rig_at({0, 0.3, 0.4}, {0, 0.1, 0}, 0.5), rig_at({40, 20, 90}, {40, 5, 0}, 100),
          rig_at({0, 0, 0}, {0, -0.5, 1}, 3)}) {
        const auto framing = frame_stage({&rig, 1});
        ASSERT_TRUE(framing);
        const OrbitView held = constrained(framing->start, framing->limits);
        EXPECT_TRUE(held.eye_m().isApprox(framing->start.eye_m(), 1e-6)) << held.eye_m();
        EXPECT_TRUE(held.pivot_m.isApprox(framing->start.pivot_m, 1e-6)) << held.pivot_m;
    }
}

TEST(StageFraming, NeedsARigWithDepth) {
    const FramedRig rig = rig_at({0, 1, 4}, {0, 1, 0}, 0);
    EXPECT_FALSE(frame_stage({&rig, 1}));
    EXPECT_FALSE(frame_stage({}));
}

}  // namespace
}  // namespace vantage

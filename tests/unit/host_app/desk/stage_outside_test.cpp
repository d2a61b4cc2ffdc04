#include "host_app/desk/panels/stage_outside.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

const DeskRect part{100, 50, 400, 300};

/// Four rigs, 4 m from the middle.
DeskPlan ring() {
    DeskPlan plan;
    for (const Eigen::Vector3d& at : {Eigen::Vector3d(4, 1, 0), {-4, 1, 0}, {0, 1, 4}, {0, 1, -4}})
        plan.rigs.push_back({"rig", at, -at.normalized()});
    return plan;
}

TEST(OutsideView, ShowsAllRigsFromEverySide) {
    OutsideEye eye;
    for (int turn = 0; turn < 12; ++turn) {
        const DeskPlan plan = ring();
        const OutsideMap map(part, plan, eye);
        for (const DeskPlan::Rig& rig : plan.rigs) {
            const auto at = map.at(rig.eye_m);
            ASSERT_TRUE(at);
            EXPECT_TRUE(part.contains(at->x, at->y)) << turn << ": " << at->x << " " << at->y;
        }
        eye.turn(0.5, 0.1);
    }
}

TEST(OutsideView, CentresTheStageAndKeepsUpUp) {
    const DeskPlan plan = ring();
    const OutsideMap map(part, plan, {});
    const auto middle = map.at(plan.extent.centre_m);
    ASSERT_TRUE(middle);
    EXPECT_NEAR(middle->x, 300, 0.01);
    EXPECT_NEAR(middle->y, 200, 0.01);
    EXPECT_LT(map.at(plan.extent.centre_m + Eigen::Vector3d(0, 1, 0))->y, middle->y);
    const OutsideMap from_front(part, plan, {0, 0.3, 0});
    EXPECT_GT(from_front.at({1, 1, 0})->x, middle->x) << "x is to the right, seen from +z";
    EXPECT_LT(from_front.at({0, 1, 1})->depth_m, from_front.at({0, 1, -1})->depth_m);
}

TEST(OutsideView, NearerIsLargerWithinLimits) {
    const DeskPlan plan = ring();
    OutsideEye eye;
    const double before = OutsideMap(part, plan, eye).at(plan.extent.centre_m)->depth_m;
    eye.go_nearer(0.5);
    EXPECT_NEAR(OutsideMap(part, plan, eye).at(plan.extent.centre_m)->depth_m,
                before * std::exp(-0.5), 1e-6);
    eye.go_nearer(100);
    EXPECT_GT(OutsideMap(part, plan, eye).at(plan.extent.centre_m)->depth_m, 0.1);
    eye.turn(0, 100);
    EXPECT_LT(eye.elevation_rad, 1.57);
    eye.turn(0, -100);
    EXPECT_GT(eye.elevation_rad, 0) << "never under the floor";
}

TEST(OutsideView, ClipsLinesBeforeTheEye) {
    const DeskPlan plan = ring();
    const OutsideEye eye{0, 0.3, 0};
    const OutsideMap map(part, plan, eye);
    const Eigen::Vector3d behind(0, 30, 100);
    EXPECT_FALSE(map.at(behind));
    EXPECT_FALSE(map.line(behind, behind + Eigen::Vector3d(1, 0, 0)));
    const auto line = map.line(plan.extent.centre_m, behind);
    ASSERT_TRUE(line);
    EXPECT_NEAR(line->from.x, 300, 0.01);
    EXPECT_NEAR(line->to.depth_m, 0.1, 1e-9);
    const auto whole = map.line(plan.rigs[0].eye_m, plan.rigs[1].eye_m);
    EXPECT_FLOAT_EQ(whole->to.x, map.at(plan.rigs[1].eye_m)->x);
}

}  // namespace
}  // namespace vantage

#include "common/geometry/pose.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using Eigen::Vector3d;

TEST(LookAt, MakesARightHandedCameraWithTheWorldsUpUpwards) {
    for (const Vector3d& eye : {Vector3d(3, 2, 4), Vector3d(-1, 0.2, -5), Vector3d(0.1, 6, 0.2)}) {
        const Vector3d target(0, 1, 0);
        const Pose pose = look_at(eye, target);
        EXPECT_NEAR(
            (pose.linear() * pose.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 0,
            1e-12);
        EXPECT_NEAR(pose.linear().determinant(), 1, 1e-12) << "no mirror image";
        EXPECT_EQ(pose.translation(), eye);
        const Vector3d seen = pose.inverse() * target;
        EXPECT_NEAR(seen.head<2>().norm(), 0, 1e-12) << "the target lies on the axis";
        EXPECT_NEAR(seen.z(), (target - eye).norm(), 1e-12) << "in front";
        const Vector3d above = pose.inverse() * (target + Vector3d(0, 0.1, 0));
        EXPECT_LT(above.y(), 0) << "y points down in the picture";
        EXPECT_NEAR(above.x(), 0, 1e-12) << "without roll";
        EXPECT_NEAR(pose.linear().col(0).y(), 0, 1e-12) << "a level horizon";
    }
}

TEST(LookAt, PutsTheWorldsRightOnTheRight) {
    const Pose pose = look_at({0, 1, 5}, {0, 1, 0});
    EXPECT_GT((pose.inverse() * Vector3d(1, 1, 0)).x(), 0);
}

TEST(Interpolate, TranslatesLinearlyAndRotatesOnTheShorterArc) {
    Pose a = Pose::Identity(), b = Pose::Identity();
    a.linear() = Eigen::AngleAxisd(-0.3, Vector3d::UnitY()).toRotationMatrix();
    b.linear() = Eigen::AngleAxisd(0.9, Vector3d::UnitY()).toRotationMatrix();
    b.translation() = Vector3d(4, 0, -2);
    EXPECT_TRUE(interpolate(a, b, 0).isApprox(a, 1e-12));
    EXPECT_TRUE(interpolate(a, b, 1).isApprox(b, 1e-12));
    const Pose quarter = interpolate(a, b, 0.25);
    EXPECT_TRUE(quarter.translation().isApprox(Vector3d(1, 0, -0.5), 1e-12));
    EXPECT_TRUE(quarter.linear().isApprox(
        Eigen::AngleAxisd(0.0, Vector3d::UnitY()).toRotationMatrix(), 1e-12));
    b.linear() = Eigen::AngleAxisd(6.0, Vector3d::UnitY()).toRotationMatrix();
    const Eigen::AngleAxisd turned(
        Eigen::Matrix3d(a.linear().transpose() * interpolate(a, b, 0.5).linear()));
    EXPECT_LT(turned.angle(), 0.1) << "6 rad is nearly all the way round to -0.28";
}

}  // namespace
}  // namespace vantage

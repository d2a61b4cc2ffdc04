#include "calib_tools/stage/camera_pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vantage {
namespace {

using testing::HasSubstr;

/// A camera on a circle of 4 m around the origin, which it looks at, this far to the side.
SingleCamera around(const std::string& name, double azimuth_deg, int width_px = 640) {
    SingleCamera camera;
    camera.name = name;
    camera.model.width_px = width_px;
    camera.model.height_px = width_px * 3 / 4;
    camera.model.fx_px = camera.model.fy_px = 0.9 * width_px;
    camera.model.cx_px = width_px / 2.0 - 0.5;
    camera.model.cy_px = width_px * 3 / 8.0 - 0.5;
    const double azimuth = azimuth_deg * 0.017453292519943295;
    camera.world_from_camera =
        look_at({4 * std::sin(azimuth), 1, 4 * std::cos(azimuth)}, {0, 1, 0});
    return camera;
}

TEST(CameraPairs, FormsRigsOfNeighboursAndNamesTheRestWithNumbers) {
    const std::vector<SingleCamera> cameras{around("a", 0), around("b", 8), around("c", 90),
                                            around("d", 97), around("e", 180)};
    EXPECT_LT((middle_of_stage(cameras) - Eigen::Vector3d(0, 1, 0)).norm(), 1e-9);
    const CameraPairs formed = form_pairs(cameras, {}, 0);
    ASSERT_EQ(formed.pairs.size(), 2u);
    for (const CameraPair& pair : formed.pairs) {
        // From above the angle grows to the right of a camera that looks inwards.
        EXPECT_EQ(pair.right, pair.left + 1);
        EXPECT_LT(pair.angle_deg, 8.001);
        EXPECT_NEAR(pair.distance_m, 4, 1e-9);
        EXPECT_GT(pair.overlap, 0.9);
        pair.calibration.validate();
        const RectifiedStereo& r = pair.calibration.rectified;
        EXPECT_LT(nearest_m(r, pair.disparities), 0.65 * 4) << "reaches the near part of the stage";
        EXPECT_FALSE(pair.calibration.place_is_assumed);
        EXPECT_TRUE(
            pair.calibration.world_from_left.isApprox(cameras[pair.left].world_from_camera));
    }
    ASSERT_EQ(formed.singles.size(), 1u);
    EXPECT_EQ(formed.singles[0].camera, 4u);
    EXPECT_THAT(formed.singles[0].reason, HasSubstr("degrees between their axes, above 25"));
}

TEST(CameraPairs, TellsWhichLimitIsBroken) {
    const auto fault = [](const SingleCamera& a, const SingleCamera& b, PairLimits limits = {}) {
        const std::vector<SingleCamera> cameras{a, b, around("far", 60)};
        return pair_of(cameras, 0, 1, Eigen::Vector3d(0, 1, 0), limits, 0).fault;
    };
    EXPECT_EQ(fault(around("a", 0), around("b", 10)), "");
    EXPECT_THAT(fault(around("a", 0), around("b", 42)), HasSubstr("42.0 degrees"));
    EXPECT_THAT(fault(around("a", 0), around("b", 10), {.most_baseline_share = 0.1}),
                HasSubstr("0.70 m at 4.00 m"));
    EXPECT_THAT(fault(around("a", 0), around("b", 10, 320)), HasSubstr("640x480 and 320x240"));
    EXPECT_THAT(fault(around("a", 0), around("b", 0.1)), HasSubstr("below 0.02 m"));
    SingleCamera above = around("b", 0);
    above.world_from_camera.translation().y() += 0.3;
    EXPECT_THAT(fault(around("a", 0), above), HasSubstr("above each other"));
    SingleCamera behind = around("b", 2);
    behind.world_from_camera.translation().z() += 0.5;
    EXPECT_THAT(fault(around("a", 0), behind), HasSubstr("behind each other"));
    SingleCamera rolled = around("b", 10);
    rolled.world_from_camera.linear() =
        rolled.world_from_camera.linear() * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ());
    EXPECT_THAT(fault(around("a", 0), rolled), HasSubstr("roll, above 20"));
    EXPECT_THAT(fault(around("a", 0), around("b", 10), {.least_overlap = 0.999}),
                HasSubstr("in common at 4.00 m"));
}

TEST(CameraPairs, RectifiesLargePicturesSmallerSoThatDisparitiesReach) {
    const std::vector<SingleCamera> cameras{around("a", 0, 3840), around("b", 8, 3840)};
    const CameraPairs formed = form_pairs(cameras, {}, 0);
    ASSERT_EQ(formed.pairs.size(), 1u);
    EXPECT_LT(formed.pairs[0].calibration.rectified.width_px, 3840);
    EXPECT_LE(formed.pairs[0].disparities, 256);
    EXPECT_LT(nearest_m(formed.pairs[0].calibration.rectified, formed.pairs[0].disparities), 2.6);
}

}  // namespace
}  // namespace vantage

#include "host_app/foreground/motion/rig_agreement.h"

#include <gtest/gtest.h>

#include "host_app/foreground/motion/rig_motion.h"
#include "tests/unit/host_app/motion/moving_square.h"

namespace vantage {
namespace {

/// Two rigs side by side, 0.3 m apart, facing a square two metres away.
class RigAgreementTest : public testing::Test {
  protected:
    static constexpr int parallax_px = 24;
    struct Rig {
        RigFrame first, second;
        RigMotion motion;
    };

    static Rig rig_at(double x_m, int first_x, int second_x) {
        Rig rig{frame_at(first_x, 0), frame_at(second_x, 1000), {}};
        for (RigFrame* frame : {&rig.first, &rig.second}) {
            frame->geometry = {width, height, 160, 79.5, 79.5, 59.5, 0.25};
            frame->world_from_camera.translation().x() = x_m;
        }
        rig.motion = motion_between(rig.first, rig.second);
        return rig;
    }
    static void agree(std::vector<Rig>& rigs) {
        std::vector<FollowedRig> followed;
        for (Rig& rig : rigs) followed.push_back({&rig.first, &rig.second, &rig.motion});
        agree_on_motion(followed);
    }
    /// In the middle of the square.
    static bool follows(const Rig& rig, int x) {
        return rig.motion.is_followed(height / 2, x) && rig.motion.is_sure_first(height / 2, x);
    }

    std::vector<Rig> rigs_{rig_at(0, 80, 88), rig_at(0.3, 80 - parallax_px, 88 - parallax_px)};
    const int in_first_ = 80 + square / 2, in_second_ = in_first_ - parallax_px;
};

TEST_F(RigAgreementTest, FollowsMotionThatBothRigsSeeAlike) {
    agree(rigs_);
    EXPECT_TRUE(follows(rigs_[0], in_first_));
    EXPECT_TRUE(follows(rigs_[1], in_second_));
}

TEST_F(RigAgreementTest, FollowsNoMotionThatTheOtherRigDoesNotFollow) {
    std::vector<int> all;
    for (int region = 1; region < rigs_[1].motion.regions; ++region) all.push_back(region);
    leave_alone(rigs_[1].motion, all);
    ASSERT_TRUE(follows(rigs_[0], in_first_));
    agree(rigs_);
    EXPECT_FALSE(follows(rigs_[0], in_first_));
    const RigFrame between = frame_between(rigs_[0].first, rigs_[0].second, rigs_[0].motion, 0.25);
    EXPECT_EQ(between.colour(height / 2, in_first_), rigs_[0].first.colour(height / 2, in_first_));
}

TEST_F(RigAgreementTest, FollowsNoContradictoryMotion) {
    rigs_[1] = rig_at(0.3, 80 - parallax_px, 72 - parallax_px);
    ASSERT_TRUE(follows(rigs_[1], in_second_));
    agree(rigs_);
    EXPECT_FALSE(follows(rigs_[0], in_first_));
    EXPECT_FALSE(follows(rigs_[1], in_second_));
}

TEST_F(RigAgreementTest, IgnoresRigsThatDoNotSeeThePoint) {
    rigs_[1] = rig_at(3, 80 - parallax_px, 72 - parallax_px);
    agree(rigs_);
    EXPECT_TRUE(follows(rigs_[0], in_first_));
    EXPECT_TRUE(follows(rigs_[1], in_second_));
}

TEST_F(RigAgreementTest, ChecksNothingWithoutDisparity) {
    rigs_[1] = rig_at(0.3, 80 - parallax_px, 72 - parallax_px);
    rigs_[1].first.disparity = rigs_[1].second.disparity = DisparityImage();
    agree(rigs_);
    EXPECT_TRUE(follows(rigs_[0], in_first_));
}

}  // namespace
}  // namespace vantage

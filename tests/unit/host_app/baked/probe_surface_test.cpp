#include "host_app/baked/probe_surface.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

constexpr int width_px = 64, height_px = 48;
constexpr float wall_m = 4;

Eigen::Matrix3d intrinsics() {
    Eigen::Matrix3d K;
    K << 60, 0, 31.5, 0, 60, 23.5, 0, 0, 1;
    return K;
}

VirtualView probe() { return {width_px, height_px, intrinsics(), Pose::Identity()}; }

/// A rig that looks at a wall of one colour and stands aside from the probe.
std::shared_ptr<BackgroundPicture> rig_at(const std::string& name, double x_m,
                                          const cv::Vec4b& colour) {
    auto rig = std::make_shared<BackgroundPicture>();
    rig->camera.name = name;
    rig->camera.K = intrinsics();
    rig->camera.world_from_camera.translate(Eigen::Vector3d(x_m, 0, 0));
    rig->colour = ColourImage(height_px, width_px, colour);
    rig->depth_m = DepthImage(height_px, width_px, wall_m);
    return rig;
}

/// Every rig has the wall at every pixel.
cv::Mat4f walls(float left_m = wall_m, float right_m = wall_m) {
    return cv::Mat4f(height_px, width_px, cv::Vec4f(left_m, right_m, 0, 0));
}

ProbeSurface surface_of(const cv::Mat4f& candidates_m,
                        const std::vector<std::shared_ptr<const BackgroundPicture>>& rigs) {
    return probe_surface(probe(), candidates_m, rigs);
}

const cv::Vec4b grey(100, 100, 100, 255), red(200, 20, 20, 255);
constexpr double aside_m = 0.2;  // 3 px of parallax at the wall
const cv::Point middle(32, 24);

TEST(ProbeSurface, IsWhatAllRigsHave) {
    const auto left = rig_at("left", -aside_m, grey), right = rig_at("right", aside_m, grey);
    const ProbeSurface surface = surface_of(walls(), {left, right});
    EXPECT_EQ(surface.rigs, (std::vector<std::string>{"left", "right"}));
    EXPECT_FLOAT_EQ(surface.depth_m(middle), wall_m);
    EXPECT_EQ(surface.colour(middle), grey);
    EXPECT_EQ(surface.visibility(middle), cv::Vec4b(255, 255, 0, 0));
}

TEST(ProbeSurface, IsNothingWhereNoRigHasAny) {
    const auto left = rig_at("left", -aside_m, grey);
    const ProbeSurface surface = surface_of(walls(0, 0), {left});
    EXPECT_EQ(surface.depth_m(middle), 0);
    EXPECT_EQ(surface.colour(middle)[3], 0);
}

TEST(ProbeSurface, DropsWhatAnotherRigSeesThroughInAnotherColour) {
    const auto left = rig_at("left", -aside_m, grey), right = rig_at("right", aside_m, grey);
    // At 2 m the left rig's parallax is 6 px.
    const cv::Rect speck(middle.x + 5, middle.y - 1, 3, 3);
    left->depth_m(speck) = wall_m / 2;
    left->colour(speck) = red;
    cv::Mat4f candidates = walls();
    candidates(middle) = cv::Vec4f(wall_m / 2, wall_m, 0, 0);
    const ProbeSurface surface = surface_of(candidates, {left, right});
    EXPECT_FLOAT_EQ(surface.depth_m(middle), wall_m);
    EXPECT_EQ(surface.colour(middle), grey);
}

TEST(ProbeSurface, KeepsAPoleThatBothRigsHave) {
    const auto left = rig_at("left", -aside_m, grey), right = rig_at("right", aside_m, grey);
    for (const auto& [rig, x] : {std::pair(left, middle.x + 6), {right, middle.x - 6}}) {
        const cv::Rect pole(x, 0, 1, height_px);
        rig->depth_m(pole) = wall_m / 2;
        rig->colour(pole) = red;
    }
    // In the probe's view the rigs differ by a pixel: behind the pole of one the other has the
    // wall.
    cv::Mat4f candidates = walls();
    candidates(middle) = cv::Vec4f(wall_m / 2, wall_m, 0, 0);
    const ProbeSurface surface = surface_of(candidates, {left, right});
    EXPECT_FLOAT_EQ(surface.depth_m(middle), wall_m / 2);
    EXPECT_EQ(surface.colour(middle), red);
}

TEST(ProbeSurface, CountsARigLittleBesideAThingThatStandsBefore) {
    const auto left = rig_at("left", -aside_m, grey), right = rig_at("right", aside_m, grey);
    // The left rig sees the wall's middle at column 35; half of what it sees there is the thing.
    left->depth_m(cv::Rect(36, 0, 4, height_px)) = wall_m / 2;
    left->colour(cv::Rect(36, 0, 4, height_px)) = red;
    left->camera.K(0, 2) += 0.5;
    const ProbeSurface surface = surface_of(walls(), {left, right});
    EXPECT_LT(surface.visibility(middle)[0], 40);
    EXPECT_EQ(surface.visibility(middle)[1], 255);
    EXPECT_NEAR(surface.colour(middle)[0], grey[0], 10);
}

TEST(ProbeSurface, IsInpaintedWhereNoRigHasMeasured) {
    const auto left = rig_at("left", -aside_m, grey);
    left->depth_m = -left->depth_m;
    const ProbeSurface surface = surface_of(walls(wall_m, 0), {left});
    EXPECT_FLOAT_EQ(surface.depth_m(middle), -wall_m);
}

}  // namespace
}  // namespace vantage

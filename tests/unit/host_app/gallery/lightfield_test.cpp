#include <gtest/gtest.h>

#include "host_app/gallery/camera_plane.h"
#include "host_app/view_sets/image_metrics.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/gallery/gallery_rendering.h"
#include "tests/unit/host_app/gallery/gallery_scene.h"

namespace vantage {
namespace {

const cv::Size size(121, 91);

/// From a place 3 m before the ball, along z.
DepthView seen_at(double x_m, double y_m, bool has_ball = true) {
    Pose pose = Pose::Identity();
    pose.translation() = Eigen::Vector3d(x_m, y_m, -3);
    Eigen::Matrix3d K;
    K << 0.9 * size.width, 0, 0.5 * (size.width - 1), 0, 0.9 * size.width, 0.5 * (size.height - 1),
        0, 0, 1;
    return BallScene{has_ball}.seen_from(pose, K, size);
}

std::vector<DepthView> grid(int columns, int rows, double step_m, bool has_ball = true) {
    std::vector<DepthView> views;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            views.push_back(seen_at(step_m * (i - 0.5 * (columns - 1)),
                                    step_m * (j - 0.5 * (rows - 1)) - 0.2, has_ball));
            views.back().name = std::to_string(views.size());
        }
    return views;
}

using LightFieldTest = GalleryRendering;

TEST_F(LightFieldTest, MatchesSurfacesInTheFocalPlaneWithoutDepth) {
    std::vector<DepthView> views = grid(5, 3, 0.3, false);
    for (DepthView& view : views) view.depth_m.release();
    const DepthView truth = seen_at(0.11, -0.13, false);
    const ColourImage picture = render("lightfield:focal-m=5", views, view_of_scene(truth));
    const cv::Mat1b wall = truth.depth_m == 5.0f;
    EXPECT_GT(psnr_db(picture, truth.colour, wall), 34);
    EXPECT_GT(psnr_db(picture, truth.colour, wall),
              6 + psnr_db(render("lightfield:focal-m=3", views, view_of_scene(truth)), truth.colour,
                          wall))
        << "out of focus";
}

TEST_F(LightFieldTest, IsSharpWhereRaysAreCorrectedByDepth) {
    const std::vector<DepthView> views = grid(3, 3, 0.3);
    const DepthView truth = seen_at(0.11, -0.13);
    const ColourImage plain = render("lightfield:focal-m=5", views, view_of_scene(truth));
    const ColourImage corrected =
        render("lightfield:focal-m=5,rays=corrected", views, view_of_scene(truth));
    EXPECT_GT(psnr_db(corrected, truth.colour), 3 + psnr_db(plain, truth.colour));
    EXPECT_GT(psnr_db(corrected, truth.colour), 26);
}

TEST_F(LightFieldTest, BlursWhatIsOutOfFocusTheMoreTheWiderTheAperture) {
    const std::vector<DepthView> views = grid(7, 1, 0.1);
    const DepthView truth = seen_at(0.02, -0.2);
    const auto ball_error = [&](const char* name) {
        const cv::Mat1b ball = truth.depth_m < 3.1f;
        return mean_error(render(name, views, view_of_scene(truth)), truth.colour, ball);
    };
    EXPECT_GT(ball_error("lightfield:focal-m=5,aperture-m=0.8"),
              1.5 * ball_error("lightfield:focal-m=5"));
}

TEST_F(LightFieldTest, BridgesAMissingCameraOfTheRow) {
    std::vector<DepthView> views = grid(5, 1, 0.1, false);
    const DepthView truth = views[2];
    views.erase(views.begin() + 2);
    const ColourImage picture = render("lightfield:focal-m=5", views, view_of_scene(truth));
    EXPECT_EQ(coverage(picture), 1);
    EXPECT_GT(psnr_db(picture, truth.colour, truth.depth_m == 5.0f), 34);
}

TEST_F(LightFieldTest, RefusesArraysThatAreNoLightField) {
    const VirtualView target = view_of_scene(seen_at(0, 0));
    const auto refusal = [&](std::span<const DepthView> views) {
        return thrown_sentence([&] { render("lightfield", views, target); });
    };
    const std::vector<DepthView> one = grid(1, 1, 1);
    EXPECT_NE(refusal(one).find("at least two cameras"), std::string::npos);
    std::vector<DepthView> blind = grid(2, 1, 0.2);
    for (DepthView& view : blind) view.depth_m.release();
    EXPECT_NE(refusal(blind).find("lightfield:focal-m="), std::string::npos);
    std::vector<DepthView> against = grid(2, 1, 0.2);
    against[1].world_from_camera = look_at({0.4, 0, 3}, {0, 0, 0}, {0, -1, 0});
    EXPECT_NE(refusal(against).find("face the same way"), std::string::npos);
    std::vector<DepthView> deep = grid(2, 1, 0.2);
    deep[1].world_from_camera.translation().z() -= 1;
    EXPECT_NE(refusal(deep).find("are 1.00 m in front of others"), std::string::npos);
}

TEST(CameraPlane, FindsTheColumnsAndRowsOfAGrid) {
    std::vector<Pose> poses;
    for (const DepthView& view : grid(3, 2, 0.25)) poses.push_back(view.world_from_camera);
    const CameraPlane plane = camera_plane(poses);
    ASSERT_EQ(plane.refusal, "");
    EXPECT_FALSE(plane.is_row);
    for (const PlacedCamera& camera : plane.cameras)
        EXPECT_TRUE(camera.reach_m.isApproxToConstant(0.25, 1e-9)) << camera.reach_m.transpose();
}

TEST(CameraPlane, LetsARowReachAnyHeight) {
    std::vector<Pose> poses;
    for (const DepthView& view : grid(4, 1, 0.25)) poses.push_back(view.world_from_camera);
    poses.erase(poses.begin() + 1);
    const CameraPlane plane = camera_plane(poses);
    ASSERT_EQ(plane.refusal, "");
    EXPECT_TRUE(plane.is_row);
    EXPECT_TRUE(plane.cameras[0].reach_m.isApprox(Eigen::Vector4d(0.5, 0.5, 0, 0), 1e-9));
    EXPECT_TRUE(plane.cameras[1].reach_m.isApprox(Eigen::Vector4d(0.5, 0.25, 0, 0), 1e-9));
}

}  // namespace
}  // namespace vantage

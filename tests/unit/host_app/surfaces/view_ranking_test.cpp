#include "host_app/views/view_ranking.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "host_app/views/depth_view.h"
#include "host_app/views/projection.h"

namespace vantage {
namespace {

/// A camera that looks along z from the origin, 90 degrees wide.
VirtualView camera() {
    VirtualView view{100, 100, Eigen::Matrix3d::Identity(), Pose::Identity()};
    view.K << 50, 0, 50, 0, 50, 50, 0, 0, 1;
    return view;
}

/// A view for most_useful().
class Place {
  public:
    Place(const std::string& name, double x_m, std::vector<Eigen::Vector3d> points_m)
        : points_m_(std::move(points_m)) {
        camera_.name = name;
        camera_.world_from_camera.translation().x() = x_m;
    }
    const DepthView& camera() const { return camera_; }
    std::span<const Eigen::Vector3d> sample_points_m() const { return points_m_; }

  private:
    DepthView camera_;
    std::vector<Eigen::Vector3d> points_m_;
};

TEST(Usefulness, IsTheSumOfInverseAnglesBetweenTheLinesOfSight) {
    const std::vector<Eigen::Vector3d> ahead = {{0, 0, 2}};
    // From the same place, from 45 degrees aside, from opposite.
    EXPECT_NEAR(usefulness(ahead, {0, 0, 0}, camera()), 1 / 0.02, 1e-9);
    EXPECT_NEAR(usefulness(ahead, {2, 0, 0}, camera()), 1 / (M_PI / 4 + 0.02), 1e-9);
    EXPECT_NEAR(usefulness(ahead, {0, 0, 4}, camera()), 1 / (M_PI + 0.02), 1e-6);
    const std::vector<Eigen::Vector3d> three(3, ahead[0]);
    EXPECT_NEAR(usefulness(three, {2, 0, 0}, camera()), 3 / (M_PI / 4 + 0.02), 1e-9);
}

TEST(Usefulness, CountsPointsInThePictureAndAQuarterOfItBeyond) {
    const auto use = [](double x_m, double y_m, double z_m) {
        const std::vector<Eigen::Vector3d> point = {{x_m, y_m, z_m}};
        return usefulness(point, {0, 0, 0}, camera()) > 0;
    };
    EXPECT_TRUE(use(1.49, 0, 1)) << "x = 124.5 px of 100 and 25";
    EXPECT_FALSE(use(1.51, 0, 1));
    EXPECT_TRUE(use(0, -1.49, 1));
    EXPECT_FALSE(use(0, -1.51, 1));
    EXPECT_FALSE(use(0, 0, -1)) << "behind the camera";
    EXPECT_FALSE(use(0, 0, 0));
}

TEST(MostUseful, ReturnsTheBestFirstWithoutUselessViews) {
    const std::vector<Eigen::Vector3d> ahead = {{0, 0, 2}}, behind = {{0, 0, -2}};
    const Place far("far", 3, ahead), near("near", 0.1, ahead), blind("blind", 0, behind),
        middle("middle", -1, ahead), as_near("as near", -0.1, ahead);
    const std::vector<const Place*> all = {&far, &near, &blind, &middle, &as_near};
    const auto names = [&](std::size_t at_most) {
        std::string listed;
        for (const Place* place : most_useful(all, camera(), at_most))
            listed += place->camera().name + ";";
        return listed;
    };
    // Of two equal views, the earlier one comes first.
    EXPECT_EQ(names(9), "near;as near;middle;far;");
    EXPECT_EQ(names(2), "near;as near;");
    EXPECT_EQ(names(0), "");
}

TEST(SurfaceSamples, AreWorldPointsEvenlyOverThePicture) {
    DepthView view;
    view.colour = ColourImage(48, 96);
    view.K << 96, 0, 47.5, 0, 96, 23.5, 0, 0, 1;
    view.world_from_camera.translation() = Eigen::Vector3d(1, 2, 3);
    // A map of half the picture's size; the right third has no depth.
    view.depth_m = DepthImage(24, 48, 4.0f);
    view.depth_m.colRange(0, 16) = 2.0f;
    view.depth_m.colRange(32, 48) = 0.0f;
    const SurfaceSamples samples = surface_samples(view);
    ASSERT_EQ(samples.points_m.size(), 12u * 8);
    EXPECT_EQ(samples.median_depth_m, 4);
    // The first is of the map's pixel (2, 1): of the picture's (4.5, 2.5).
    EXPECT_LT((samples.points_m[0] -
               Eigen::Vector3d(1 + 2 * (4.5 - 47.5) / 96, 2 + 2 * (2.5 - 23.5) / 96, 5))
                  .norm(),
              1e-9);
    view.depth_m.setTo(0.0f);
    EXPECT_TRUE(surface_samples(view).points_m.empty());
    EXPECT_EQ(surface_samples(view).median_depth_m, 0);
}

TEST(Parallax, IsTheMovementByARelativeChangeOfInverseDepth) {
    DepthView other;
    other.K = camera().K;
    other.world_from_camera.translation() = Eigen::Vector3d(0.5, 0.1, -0.2);
    const Eigen::Matrix4d map = pixel_from_target_pixel(other, camera());
    const Eigen::Vector2d pixel(30, 60);
    const auto place = [&](double depth_m) {
        const Eigen::Vector4d q =
            map * Eigen::Vector4d(pixel.x() * depth_m, pixel.y() * depth_m, depth_m, 1);
        return Eigen::Vector2d(q.head<2>() / q.z());
    };
    constexpr double change = 1e-6;
    EXPECT_NEAR(parallax_px(map, pixel, 4), (place(4 / (1 + change)) - place(4)).norm() / change,
                1e-3);
    EXPECT_EQ(parallax_px(map, pixel, 0), 0) << "no depth";
}

}  // namespace
}  // namespace vantage

#include "host_app/background/scene_planes.h"

#include <cmath>

#include <gtest/gtest.h>

namespace vantage {
namespace {

const cv::Size map_size{160, 120};
const ScenePlane floor_plane(0, -1, 0, 0);
constexpr double eye_height_m = 1.5, wall_m = 8, tolerance_per_m = 0.002;

/// A camera at x that looks along z. World y points down, and the floor is at y = 0.
DepthMapView camera_at(double x_m) {
    DepthMapView view;
    view.K << 150, 0, 80, 0, 150, 60, 0, 0, 1;
    view.world_from_camera.translation() = Eigen::Vector3d(x_m, -eye_height_m, 0);
    view.tolerance_per_m = tolerance_per_m;
    return view;
}

/// A floor before a wall, with noise of a third of the tolerance.
DepthImage floor_and_wall(const DepthMapView& view) {
    const Eigen::RowVector3d floor = inverse_depth_of(floor_plane, view.K, view.world_from_camera);
    DepthImage depth_m(map_size);
    cv::RNG noise(7);
    for (int y = 0; y < map_size.height; ++y)
        for (int x = 0; x < map_size.width; ++x)
            depth_m(y, x) =
                static_cast<float>(1 / (std::max(floor.dot(Eigen::Vector3d(x, y, 1)), 1 / wall_m) +
                                        noise.gaussian(tolerance_per_m / 3)));
    return depth_m;
}

TEST(ScenePlanes, HaveAnInverseDepthThatIsLinearInThePixel) {
    const DepthMapView view = camera_at(0.3);
    const Eigen::RowVector3d depth = inverse_depth_of(floor_plane, view.K, view.world_from_camera);
    // The ray through v = 90 falls by 30 / 150 per metre.
    EXPECT_NEAR(depth.dot(Eigen::Vector3d(20, 90, 1)), 0.2 / eye_height_m, 1e-9);
    EXPECT_LT(depth.dot(Eigen::Vector3d(20, 30, 1)), 0) << "above the horizon";
}

TEST(ScenePlanes, AreFoundInTheDepthOfSeveralCameras) {
    std::vector<DepthMapView> views{camera_at(-0.4), camera_at(0.4)};
    const DepthImage left_m = floor_and_wall(views[0]), right_m = floor_and_wall(views[1]);
    views[0].depth_m = &left_m;
    views[1].depth_m = &right_m;
    const std::vector<ScenePlane> planes = planes_of(views, 5);
    ASSERT_EQ(planes.size(), 2U) << "the remaining points are on no plane";
    const ScenePlane wall(0, 0, 1, -wall_m);
    for (const ScenePlane& expected : {floor_plane, wall}) {
        double nearest = 1;
        for (const ScenePlane& plane : planes)
            nearest = std::min({nearest, (plane - expected).norm(), (plane + expected).norm()});
        EXPECT_LT(nearest, 0.05) << expected.transpose();
    }
}

TEST(ScenePlanes, BeginWithTheExpectedOnesThatAreThere) {
    std::vector<DepthMapView> views{camera_at(0)};
    const DepthImage depth_m = floor_and_wall(views[0]);
    views[0].depth_m = &depth_m;
    const std::vector<ScenePlane> expected{ScenePlane(1, 0, 0, 2), floor_plane};
    const std::vector<ScenePlane> planes = planes_of(views, 5, expected);
    ASSERT_EQ(planes.size(), 2U);
    EXPECT_EQ(planes.front(), floor_plane);
}

TEST(ScenePlanes, AreNotFoundInNoise) {
    std::vector<DepthMapView> views{camera_at(0)};
    DepthImage depth_m(map_size);
    cv::RNG noise(7);
    for (float& z : depth_m) z = static_cast<float>(noise.uniform(2.0, 8.0));
    views[0].depth_m = &depth_m;
    EXPECT_TRUE(planes_of(views, 5).empty());
    depth_m = 0.0f;
    EXPECT_TRUE(planes_of(views, 5).empty());
}

}  // namespace
}  // namespace vantage

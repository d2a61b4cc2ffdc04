#include "common/geometry/camera_model.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

CameraModel plain_camera() {
    CameraModel camera;
    camera.width_px = 640;
    camera.height_px = 480;
    camera.fx_px = 520;
    camera.fy_px = 515;
    camera.cx_px = 322.5;
    camera.cy_px = 236.25;
    return camera;
}

struct Lens {
    LensModel model;
    std::vector<double> distortion;
};

std::vector<Lens> lenses() {
    return {
        {LensModel::pinhole, {}},
        {LensModel::pinhole, {-0.28, 0.07, 0.0012, -0.0007}},
        {LensModel::pinhole, {-0.28, 0.07, 0.0012, -0.0007, 0.01}},
        {LensModel::pinhole, {0.2, -0.1, 0.0005, 0.001, 0.02, 0.35, -0.08, 0.03}},
        {LensModel::pinhole,
         {-0.2, 0.05, 0.001, -0.001, 0.0, 0.02, 0.01, 0.0, 0.002, -0.001, 0.0015, 0.0005}},
        {LensModel::pinhole,
         {-0.2, 0.05, 0.001, -0.001, 0.0, 0.02, 0.01, 0.0, 0.002, -0.001, 0.0015, 0.0005, 0.02,
          -0.015}},
        {LensModel::fisheye, {}},
        {LensModel::fisheye, {0.05, -0.01, 0.004, -0.001}},
    };
}

class EveryLens : public testing::TestWithParam<Lens> {
  protected:
    EveryLens() : camera_(plain_camera()) {
        camera_.lens = GetParam().model;
        camera_.distortion = GetParam().distortion;
        camera_.skew_px = 1.5;
    }
    CameraModel camera_;
};

TEST_P(EveryLens, UnprojectsEveryPixelToTheRayThatProjectsThere) {
    camera_.validate();
    for (int y = 0; y < camera_.height_px; y += 43)
        for (int x = 0; x < camera_.width_px; x += 57) {
            const Eigen::Vector3d ray = camera_.unproject({x, y});
            EXPECT_EQ(ray.z(), 1);
            const auto pixel = camera_.project(2.75 * ray);
            ASSERT_TRUE(pixel);
            EXPECT_LT((*pixel - Eigen::Vector2d(x, y)).norm(), 1e-4) << x << ", " << y;
        }
}

TEST_P(EveryLens, ProjectsTheAxisToTheCentre) {
    const auto pixel = camera_.project({0, 0, 3});
    ASSERT_TRUE(pixel);
    EXPECT_LT((*pixel - Eigen::Vector2d(camera_.cx_px, camera_.cy_px)).norm(), 1e-9);
}

TEST_P(EveryLens, ProjectsNoPointAtOrBehindTheCamera) {
    EXPECT_FALSE(camera_.project({0.1, 0.2, 0}));
    EXPECT_FALSE(camera_.project({0.1, 0.2, -1}));
}

INSTANTIATE_TEST_SUITE_P(Lenses, EveryLens, testing::ValuesIn(lenses()));

TEST(CameraModel, AgreesWithTheFormulas) {
    CameraModel camera = plain_camera();
    camera.skew_px = 2;
    const auto pinhole = camera.project({0.3, -0.2, 2});
    ASSERT_TRUE(pinhole);
    EXPECT_NEAR(pinhole->x(), 520 * 0.15 + 2 * -0.1 + 322.5, 1e-12);
    EXPECT_NEAR(pinhole->y(), 515 * -0.1 + 236.25, 1e-12);

    camera.skew_px = 0;
    camera.distortion = {0.1, 0.02, 0.001, 0.002};
    const auto bent = camera.project({0.3, -0.2, 2});
    const double x = 0.15, y = -0.1, r2 = x * x + y * y, radial = 1 + 0.1 * r2 + 0.02 * r2 * r2;
    EXPECT_NEAR(bent->x(),
                520 * (x * radial + 2 * 0.001 * x * y + 0.002 * (r2 + 2 * x * x)) + 322.5, 1e-9);

    camera.lens = LensModel::fisheye;
    camera.distortion = {};
    const auto fisheye = camera.project({1, 0, 1});
    EXPECT_NEAR(fisheye->x(), 520 * std::atan(1.0) + 322.5, 1e-9)
        << "without coefficients the angle itself";
}

TEST(CameraModel, RefusesInvalidValues) {
    const auto refusal = [](auto change) -> std::string {
        CameraModel camera = plain_camera();
        change(camera);
        return thrown_sentence([&] { camera.validate(); });
    };
    EXPECT_EQ(refusal([](CameraModel&) {}), "");
    EXPECT_NE(refusal([](CameraModel& c) { c.width_px = 0; }).find("0x480"), std::string::npos);
    EXPECT_NE(refusal([](CameraModel& c) { c.fx_px = -3; }).find("-3"), std::string::npos);
    EXPECT_NE(refusal([](CameraModel& c) { c.fy_px = INFINITY; }).find("inf"), std::string::npos);
    EXPECT_NE(refusal([](CameraModel& c) { c.cx_px = NAN; }).find("nan"), std::string::npos);
    EXPECT_NE(refusal([](CameraModel& c) {
                  c.distortion = {0, NAN, 0, 0};
              }).find("finite"),
              std::string::npos);
    EXPECT_NE(refusal([](CameraModel& c) {
                  c.distortion = {1, 2, 3};
              }).find("3 are given"),
              std::string::npos);
    EXPECT_NE(refusal([](CameraModel& c) {
                  c.lens = LensModel::fisheye;
                  c.distortion.resize(5);
              }).find("5 are given"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage

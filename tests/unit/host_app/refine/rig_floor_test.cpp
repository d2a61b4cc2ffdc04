#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "host_app/refine/multi_view_refinement.h"
#include "host_app/surfaces/rig_history.h"

namespace vantage {
namespace {

const cv::Size size{161, 119};
/// A part of the floor with wrong depth beyond it.
const cv::Rect strip(70, 60, 16, 30);

/// A rig at x = `aside_m` that looks down at a plain floor at y = 0.
DepthView film_of_floor(double aside_m, double eye_height_m = 1.5) {
    DepthView view;
    view.name = std::to_string(aside_m);
    view.K << 150, 0, 80, 0, 150, 59, 0, 0, 1;
    const Eigen::Vector3d eye(aside_m, eye_height_m, 0);
    view.world_from_camera = look_at(eye, eye + Eigen::Vector3d(0, -1.5, 3));
    view.baseline_m = 0.05;
    view.colour = ColourImage(size, cv::Vec4b(200, 210, 205, 255));
    view.depth_m = DepthImage(size);
    const Eigen::Matrix3d ray_of = view.world_from_camera.linear() * view.K.inverse();
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const double down = -(ray_of * Eigen::Vector3d(x, y, 1)).y();
            view.depth_m(y, x) = down > 0.05 ? static_cast<float>(1.5 / down) : 0.0f;
        }
    return view;
}

class RigFloorTest : public testing::Test {
  protected:
    /// The refined strip of the first of three rigs.
    DepthImage refined(const cv::Vec4b& strip_colour, double eye_height_m = 1.5) {
        DepthView own = film_of_floor(0, eye_height_m);
        floor_m_ = own.depth_m.clone();
        wrong_m_ = 1.4f * floor_m_;
        wrong_m_(strip).copyTo(own.depth_m(strip));
        own.colour(strip) = strip_colour;
        const DepthView rigs[] = {own, film_of_floor(-0.4, eye_height_m),
                                  film_of_floor(0.4, eye_height_m)};
        RigRoster views;
        views.upload(rigs, nominal_dt_s);
        return DepthImage(
            refinement_.refine_background(compared(*views.shown()[0]), compared(views.shown()))
                .download())(strip);
    }
    int like(const DepthImage& depth_m, const DepthImage& map_m) const {
        return cv::countNonZero(cv::abs(depth_m - map_m(strip)) < 0.01 * map_m(strip));
    }

    EglContext context_;
    ShaderLibrary shaders_;
    MultiViewRefinement refinement_{shaders_};
    DepthImage floor_m_, wrong_m_;
};

TEST_F(RigFloorTest, PutsAPlainFloorAtYEqualTo0) {
    EXPECT_EQ(like(refined({200, 210, 205, 255}), floor_m_), strip.area());
}

TEST_F(RigFloorTest, KeepsDepthWhoseColoursDoNotMatchOnTheFloor) {
    EXPECT_EQ(like(refined({20, 40, 160, 255}), floor_m_), 0);
}

TEST_F(RigFloorTest, KeepsDepthIfTheRigsSeeNoFloor) {
    EXPECT_EQ(like(refined({200, 210, 205, 255}, 2.5), floor_m_), 0);
}

}  // namespace
}  // namespace vantage

#include "host_app/view_sets/outline_depth.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

constexpr double radius_m = 0.5;

/// A view of a ball around the origin from 3 m, and the ball's outline.
struct BallView {
    explicit BallView(double azimuth_deg) {
        view.name = std::to_string(azimuth_deg);
        view.colour = ColourImage(120, 160, cv::Vec4b(9, 9, 9, 255));
        view.K << 150, 0, 79.5, 0, 150, 59.5, 0, 0, 1;
        const double azimuth = azimuth_deg * 0.017453292519943295;
        view.world_from_camera =
            look_at({3 * std::sin(azimuth), 0, 3 * std::cos(azimuth)}, {0, 0, 0});
        outline = GreyImage(120, 160);
        for (int y = 0; y < 120; ++y)
            for (int x = 0; x < 160; ++x)
                outline(y, x) = distance_of_ray(x, y) < radius_m ? 255 : 0;
    }
    double distance_of_ray(int x, int y) const {
        const Eigen::Vector3d ray = (view.K.inverse() * Eigen::Vector3d(x, y, 1)).normalized();
        return ray.cross(Eigen::Vector3d(0, 0, 3)).norm();
    }
    DepthView view;
    GreyImage outline;
};

TEST(OutlineDepth, CarvesABallFromItsOutlines) {
    std::vector<DepthView> views;
    std::vector<GreyImage> outlines;
    for (int i = 0; i < 8; ++i) {
        const BallView ball(45.0 * i);
        views.push_back(ball.view);
        outlines.push_back(ball.outline);
    }
    set_depth_from_outlines(views, outlines);
    for (const DepthView& view : views) {
        ASSERT_EQ(view.depth_m.size(), cv::Size(160, 120));
        EXPECT_EQ(view.depth_m(5, 5), 0) << "no depth outside the outline";
        // The hull of a ball encloses it: its surface is never behind the ball's, and near to it.
        EXPECT_LT(view.depth_m(60, 80), 3 - radius_m + 0.01);
        EXPECT_GT(view.depth_m(60, 80), 3 - radius_m - 0.1);
    }
}

TEST(OutlineDepth, IsNotDeceivedByAViewFromTheOppositeSide) {
    std::vector<DepthView> views;
    std::vector<GreyImage> outlines;
    for (int i = 0; i < 4; ++i) {
        const BallView ball(90.0 * i);
        views.push_back(ball.view);
        outlines.push_back(ball.outline);
    }
    set_depth_from_outlines(views, outlines);
    for (const DepthView& view : views) {
        EXPECT_LT(view.depth_m(60, 80), 3 - radius_m + 0.01);
        EXPECT_GT(view.depth_m(60, 80), 3 - radius_m - 0.25);
    }
}

TEST(OutlineDepth, ShowsTheWholeHullToACameraBetweenTheViews) {
    std::vector<DepthView> views;
    std::vector<GreyImage> outlines;
    for (int i = 0; i < 4; ++i) {
        BallView ball(90.0 * i);
        ball.view.colour = cv::Vec4b(static_cast<unsigned char>(50 * (i + 1)), 0, 0, 255);
        views.push_back(ball.view);
        outlines.push_back(ball.outline);
    }
    set_depth_from_outlines(views, outlines);
    const BallView between(45);
    const DepthView hull =
        hull_view(views, outlines, {160, 120, between.view.K, between.view.world_from_camera});
    int of_ball = 0, known = 0, outside = 0;
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x) {
            const bool is_ball = between.outline(y, x) > 0, is_hull = hull.depth_m(y, x) > 0;
            of_ball += is_ball;
            known += is_ball && is_hull;
            outside += !is_ball && is_hull;
            if (!is_hull) continue;
            EXPECT_LT(hull.depth_m(y, x), 3.05f) << x << ' ' << y;
            // On its left the hull is that of the view from 0 degrees, on its right from 90.
            const int blue = hull.colour(y, x)[0];
            EXPECT_TRUE(x >= 65 || blue <= 75) << x << ' ' << y;
            EXPECT_TRUE(x <= 95 || blue >= 75) << x << ' ' << y;
        }
    EXPECT_GT(known, 0.97 * of_ball);
    EXPECT_LT(outside, 0.6 * of_ball) << "four outlines make a square prism of a ball";
}

TEST(OutlineDepth, LeavesViewsWithoutAnOutlineAlone) {
    const BallView a(0), b(90), c(45);
    std::vector<DepthView> views{a.view, b.view, c.view};
    set_depth_from_outlines(views, {a.outline, b.outline, GreyImage()});
    EXPECT_TRUE(views[2].depth_m.empty());
    EXPECT_GT(views[0].depth_m(60, 80), 2.0f);
    EXPECT_NE(thrown_sentence([&] {
                  set_depth_from_outlines(views, {a.outline, GreyImage(), GreyImage()});
              }).find("at least two views, and 1 of 3"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage

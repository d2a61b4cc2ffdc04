#include "host_app/desk/feed/stage_map.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "common/geometry/pose.h"
#include "tests/unit/host_app/frames/scripted_feed.h"

namespace vantage {
namespace {

TEST(StagePoints, AreAFewThousandColouredPointsOfTheRigsSurfaces) {
    ScriptedFeed feed({"north", "south"});
    const FrameSet set = feed.set(1, {"north", "south"}, {200, 100, 50, 255});
    const std::vector<DeskPlan::Point> points = stage_points(set);
    ASSERT_GT(points.size(), 500u);
    EXPECT_LE(points.size(), 4000u);
    std::size_t of_the_wall = 0;
    for (const DeskPlan::Point& point : points) {
        ASSERT_TRUE(point.at_m.allFinite());
        of_the_wall += point.rgb == std::array<unsigned char, 3>{200, 100, 50};
    }
    EXPECT_GT(of_the_wall, points.size() / 3) << "the rest is black";
    EXPECT_TRUE(stage_points(feed.set(2, {})).empty());
}

}  // namespace

namespace {

constexpr int width_px = 160, height_px = 120;
constexpr double f_px = 140, baseline_m = 0.2;

/// Rigs around a stage with a floor, a wall at z = -3 and a performer, an upright cylinder.
class SurfacePick : public testing::Test {
  protected:
    static constexpr double performer_radius_m = 0.2;

    /// Returns the depth of the first surface on a ray from `eye`; 0: none.
    double hit(const Eigen::Vector3d& eye, const Eigen::Vector3d& ray) const {
        double nearest = 1e9;
        const auto take = [&](double t) {
            if (t > 0) nearest = std::min(nearest, t);
        };
        take(-eye.y() / ray.y());
        take((-3 - eye.z()) / ray.z());
        const Eigen::Vector2d from(eye.x() - performer_.x(), eye.z() - performer_.y());
        const Eigen::Vector2d way(ray.x(), ray.z());
        const double a = way.squaredNorm(), b = from.dot(way),
                     c = from.squaredNorm() - performer_radius_m * performer_radius_m;
        if (const double root = b * b - a * c; root > 0) {
            const double t = (-b - std::sqrt(root)) / a, y = eye.y() + t * ray.y();
            if (y > 0 && y < 1.8) take(t);
        }
        return nearest < 1e8 ? nearest : 0;
    }
    std::shared_ptr<RigFrame> rig(const std::string& name, double azimuth_rad) const {
        auto frame = std::make_shared<RigFrame>();
        frame->rig = name;
        frame->geometry.width_px = width_px;
        frame->geometry.height_px = height_px;
        frame->geometry.f_px = f_px;
        frame->geometry.cx_left_px = frame->geometry.cx_right_px = 0.5 * (width_px - 1);
        frame->geometry.cy_px = 0.5 * (height_px - 1);
        frame->geometry.baseline_m = baseline_m;
        frame->world_from_camera =
            look_at({4 * std::sin(azimuth_rad), 1.6, 4 * std::cos(azimuth_rad)}, {0, 1, 0});
        frame->colour = ColourImage(height_px, width_px);
        frame->disparity = DisparityImage(height_px, width_px, std::uint16_t{0});
        std::mt19937 random(7);
        for (int y = 0; y < height_px; ++y)
            for (int x = 0; x < width_px; ++x) {
                const Eigen::Vector3d ray = frame->world_from_camera.linear() *
                                            Eigen::Vector3d((x - 0.5 * (width_px - 1)) / f_px,
                                                            (y - 0.5 * (height_px - 1)) / f_px, 1);
                double z = hit(frame->world_from_camera.translation(), ray);
                // One percent of wrong depths, as a matcher has.
                if (random() % 100 == 0) z = 1.5;
                if (z > 0)
                    frame->disparity(y, x) =
                        static_cast<std::uint16_t>(std::lround(32 * f_px * baseline_m / z));
            }
        return frame;
    }
    FrameSet set() const {
        FrameSet set;
        set.slots.push_back({"left", rig("left", -0.4), Absence::none});
        set.slots.push_back({"away", nullptr, Absence::disconnected});
        set.slots.push_back({"right", rig("right", 0.4), Absence::none});
        return set;
    }
    static CameraState camera() {
        CameraState camera;
        camera.world_from_camera = look_at({0.5, 1.4, 3.5}, {0, 1, 0});
        camera.field_of_view_rad = 0.9;
        return camera;
    }
    /// Returns a point's place in the camera's picture, 0..1.
    static Eigen::Vector2d place_of(const Eigen::Vector3d& point_m) {
        const Eigen::Vector3d there = camera().world_from_camera.inverse() * point_m;
        const double width = 2 * std::tan(0.45);
        return {0.5 + there.x() / there.z() / width, 0.5 + there.y() / there.z() / (0.75 * width)};
    }

    Eigen::Vector2d performer_{0.3, 0.2};  ///< x and z
};

TEST_F(SurfacePick, DetectsTheWallTheFloorAndThePerformer) {
    const FrameSet there = set();
    for (const Eigen::Vector3d& point :
         {Eigen::Vector3d(-0.9, 1.2, -3), Eigen::Vector3d(-0.5, 0, 0.5)}) {
        const auto found = surface_at(there, camera(), 0.75, place_of(point));
        ASSERT_TRUE(found) << point.transpose();
        EXPECT_LT((*found - point).norm(), 0.15) << point.transpose();
    }
    const Eigen::Vector3d chest(performer_.x(), 1.3, performer_.y());
    const auto found = surface_at(there, camera(), 0.75, place_of(chest));
    ASSERT_TRUE(found);
    EXPECT_LT((*found - chest).norm(), 0.3) << "neither the wall behind nor a wrong depth before";
}

TEST_F(SurfacePick, IsEmptyWhereNoRigHasDepth) {
    EXPECT_FALSE(surface_at(set(), camera(), 0.75, {0.5, -3}));
    EXPECT_FALSE(surface_at({}, camera(), 0.75, {0.5, 0.5}));
}

TEST_F(SurfacePick, FollowsAPerformer) {
    Eigen::Vector3d pivot(0.2, 1.1, 0.3);
    for (int i = 0; i < 20; ++i) {
        performer_ += Eigen::Vector2d(-0.05, 0.03);
        const auto found = foreground_near(set(), pivot);
        ASSERT_TRUE(found) << i;
        pivot = *found;
        EXPECT_LT(std::hypot(pivot.x() - performer_.x(), pivot.z() - performer_.y()), 0.25) << i;
        EXPECT_EQ(pivot.y(), 1.1);
    }
}

TEST_F(SurfacePick, IsEmptyWithoutAPerformerNearThePivot) {
    EXPECT_FALSE(foreground_near(set(), {-1.2, 1, 1.2}));
}

}  // namespace

namespace {

/// The corridor of two rigs 4 m in front of the stage.
std::shared_ptr<const Corridor> corridor() {
    std::vector<CorridorRig> rigs;
    for (const double azimuth : {-0.25, 0.25}) {
        OrbitView view;
        view.azimuth_rad = azimuth;
        view.distance_m = 4;
        rigs.push_back({view.world_from_camera(), 0.5, 0.4});
    }
    return std::make_shared<const Corridor>(rigs, StageExtent{}, 0.5625);
}

TEST(CorridorFieldsTest, AreCoveredAtTheRigsAndNotBehindTheStage) {
    CorridorFields fields;
    const auto there = corridor();
    for (int i = 0; i < 100; ++i) fields.follow(there, OrbitView{}, 6);
    ASSERT_FALSE(fields.fields().empty());
    const auto place_at = [&](double azimuth_rad, double distance_m) {
        for (const DeskPlan::Field& field : fields.fields())
            if (std::abs(field.azimuth_rad - azimuth_rad) <= 0.5 * field.width_rad &&
                field.from_m <= distance_m && distance_m < field.to_m)
                return field.place;
        ADD_FAILURE() << "no field there";
        return CorridorPlace::edge;
    };
    EXPECT_EQ(place_at(0, 4.2), CorridorPlace::inside);
    EXPECT_EQ(place_at(std::numbers::pi, 4.2), CorridorPlace::beyond);
}

TEST(CorridorFieldsTest, AreComputedInPartsAndShownWhenComplete) {
    CorridorFields fields;
    const auto there = corridor();
    fields.follow(there, OrbitView{}, 6);
    EXPECT_TRUE(fields.fields().empty());
    int calls = 1;
    while (fields.fields().empty() && calls < 1000) {
        fields.follow(there, OrbitView{}, 6);
        ++calls;
    }
    EXPECT_GT(calls, 3);
    EXPECT_LT(calls, 50);
    OrbitView aside;
    aside.pivot_m.x() = 1;
    fields.follow(there, aside, 6);
    EXPECT_EQ(fields.pivot_m().x(), 0) << "those of before, until the new ones are all there";
    for (int i = 0; i < 50; ++i) fields.follow(there, aside, 6);
    EXPECT_EQ(fields.pivot_m().x(), 1);
}

TEST(CorridorFieldsTest, AreEmptyWithoutACorridor) {
    CorridorFields fields;
    fields.follow(nullptr, OrbitView{}, 6);
    EXPECT_TRUE(fields.fields().empty());
}

}  // namespace

}  // namespace vantage

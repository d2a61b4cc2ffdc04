#include "host_app/flight/corridor.h"

#include <gtest/gtest.h>

#include "tests/unit/host_app/flight/ring_of_rigs.h"

namespace vantage {
namespace {

Coverage coverage(const std::shared_ptr<const Corridor>& corridor, const OrbitView& view) {
    return corridor->of(view.camera());
}

TEST(Corridor, CoversTheRigsAndEverythingBetweenTwo) {
    const auto corridor = corridor_of({-20, 20});
    for (const double azimuth_deg : {-20, -10, 0, 10, 20})
        EXPECT_GT(coverage(corridor, view_at(azimuth_deg)).share, 0.99) << azimuth_deg;
}

TEST(Corridor, CoverageFallsMonotonicallyBesideTheRigs) {
    const auto corridor = corridor_of({-10, 10});
    double last = 1;
    for (int azimuth_deg = 20; azimuth_deg <= 125; azimuth_deg += 5) {
        const double share = coverage(corridor, view_at(azimuth_deg)).share;
        EXPECT_LT(share, last + 1e-9) << azimuth_deg;
        EXPECT_GT(share, last - 0.08) << azimuth_deg;
        last = share;
    }
}

TEST(Corridor, HundredDegreesBesideTwoRigsIsBeyond) {
    const Coverage aside = coverage(corridor_of({-10, 10}), view_at(100));
    EXPECT_EQ(Corridor::place_of(aside.share), CorridorPlace::beyond) << aside.share;
    EXPECT_EQ(aside.loss, CoverageLoss::aside);
}

TEST(Corridor, ThirtyDegreesBesideIsInsideAndSixtyIsBeyond) {
    const auto corridor = corridor_of({-10, 10});
    EXPECT_EQ(Corridor::place_of(coverage(corridor, view_at(30)).share), CorridorPlace::inside);
    EXPECT_EQ(Corridor::place_of(coverage(corridor, view_at(50)).share), CorridorPlace::edge);
    EXPECT_EQ(Corridor::place_of(coverage(corridor, view_at(70)).share), CorridorPlace::beyond);
}

TEST(Corridor, TheFarSideOfTheStageIsBehind) {
    const Coverage behind = coverage(corridor_of({-10, 10}), view_at(180));
    EXPECT_LT(behind.share, 0.3);
    EXPECT_EQ(behind.loss, CoverageLoss::behind);
}

TEST(Corridor, RingOfRigsCoversAllDirections) {
    const auto corridor = corridor_of({0, 60, 120, 180, 240, 300});
    for (double azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 15)
        EXPECT_GT(coverage(corridor, view_at(azimuth_deg)).share, 0.95) << azimuth_deg;
}

TEST(Corridor, LookingAwayFromTheStageIsOutside) {
    const Coverage outside =
        coverage(corridor_of({-10, 10}), view_from_eye(view_at(0).eye_m(), {4.5, 1, 0}, 0.785));
    EXPECT_EQ(Corridor::place_of(outside.share), CorridorPlace::beyond) << outside.share;
    EXPECT_EQ(outside.loss, CoverageLoss::outside);
}

TEST(Corridor, LookingAwayFromTheStageIsBehindTheRigs) {
    const Eigen::Vector3d eye(0, 1.8, 4.4);
    const Coverage away =
        coverage(corridor_of({-10, 10}), view_from_eye(eye, eye + Eigen::Vector3d::UnitZ(), 0.785));
    EXPECT_LT(away.share, 0.05);
    EXPECT_EQ(away.loss, CoverageLoss::behind);
}

TEST(Corridor, TenthOfTheRigsDistanceIsTooNear) {
    const auto corridor = corridor_of({-10, 10});
    EXPECT_GT(coverage(corridor, view_at(0, 10, 1.5)).share, 0.99);
    const Coverage near = coverage(corridor, view_at(0, 10, 0.35));
    EXPECT_EQ(Corridor::place_of(near.share), CorridorPlace::beyond) << near.share;
    EXPECT_EQ(near.loss, CoverageLoss::too_near);
}

TEST(Corridor, NothingIsCoveredWithoutRigs) {
    EXPECT_EQ(coverage(corridor_of({}), view_at(0)).share, 0);
}

TEST(Corridor, SpeedFallsSmoothlyFromTheEdgeToTheEnd) {
    EXPECT_EQ(Corridor::outward_speed(1), 1);
    EXPECT_EQ(Corridor::outward_speed(Corridor::edge), 1);
    EXPECT_NEAR(Corridor::outward_speed(0.5 * (Corridor::edge + Corridor::end)), 0.5, 1e-9);
    EXPECT_EQ(Corridor::outward_speed(Corridor::end), 0);
    EXPECT_EQ(Corridor::outward_speed(0), 0);
}

}  // namespace
}  // namespace vantage

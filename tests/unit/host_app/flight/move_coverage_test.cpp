#include "host_app/flight/moves/move_coverage.h"

#include <gtest/gtest.h>

#include "tests/support/source_folder.h"
#include "tests/unit/host_app/flight/ring_of_rigs.h"

namespace vantage {
namespace {

Move move_through(std::initializer_list<double> azimuths_deg, bool loop = false) {
    std::vector<MoveKeyframe> keyframes;
    for (const double azimuth_deg : azimuths_deg)
        keyframes.push_back(
            {10.0 * static_cast<double>(keyframes.size()), view_at(azimuth_deg), Easing::linear});
    return Move(keyframes, loop);
}

TEST(MoveCoverage, MoveBetweenTheRigsIsCovered) {
    EXPECT_TRUE(uncovered_parts(move_through({-10, 10}), *corridor_of({-10, 10})).empty());
}

TEST(MoveCoverage, ReportsAnUncoveredPartWithItsTimesAndLeastCoverage) {
    const auto corridor = corridor_of({-10, 10});
    const Move move = move_through({0, 100, 0});
    const std::vector<UncoveredPart> parts = uncovered_parts(move, *corridor);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_GT(parts[0].from_s, 5);
    EXPECT_LT(parts[0].from_s, 7.5);
    EXPECT_NEAR(parts[0].to_s, 20 - parts[0].from_s, 0.11);
    EXPECT_NEAR(parts[0].least.share, corridor->of(view_at(100).camera()).share, 1e-9);
    EXPECT_EQ(parts[0].least.loss, CoverageLoss::aside);
}

TEST(MoveCoverage, ReportsEveryPartUpToTheEnd) {
    const std::vector<UncoveredPart> parts =
        uncovered_parts(move_through({100, 0, 100}), *corridor_of({-10, 10}));
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].from_s, 0);
    EXPECT_EQ(parts[1].to_s, 20);
}

TEST(MoveCoverage, SuppliedMovesAreCovered) {
    const Move demo = Move::load(source_folder() / "hw_config/moves/demo.toml");
    const auto corridor = corridor_of({-30, -10, 10, 30});
    for (double time_s = 0; time_s < demo.duration_s(); time_s += 0.05)
        EXPECT_EQ(Corridor::place_of(corridor->of(demo.at(time_s).camera()).share),
                  CorridorPlace::inside)
            << time_s;
}

}  // namespace
}  // namespace vantage

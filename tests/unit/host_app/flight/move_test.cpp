#include "host_app/flight/moves/move.h"

#include <cmath>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>

#include "host_app/flight/orbit_view.h"
#include "tests/support/data_folder.h"
#include "tests/support/source_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/flight/looking.h"
#include "tests/unit/host_app/flight/ring_of_rigs.h"

namespace vantage {
namespace {

OrbitView looking_down(double azimuth_rad, double distance_m = 4) {
    OrbitView view;
    view.azimuth_rad = azimuth_rad;
    view.elevation_rad = 0.2;
    view.distance_m = distance_m;
    return view;
}

Move move_of(std::vector<double> azimuths, Easing easing, bool loop = false) {
    std::vector<MoveKeyframe> keyframes;
    for (const double azimuth : azimuths)
        keyframes.push_back({static_cast<double>(keyframes.size()), looking_down(azimuth), easing});
    return Move(keyframes, loop);
}

double speed(const Move& move, double time_s) {
    constexpr double h = 1e-5;
    return (move.at(time_s + h).azimuth_rad - move.at(time_s - h).azimuth_rad) / (2 * h);
}

TEST(Move, PassesThroughEveryKeyframe) {
    const Move move = move_of({0, 1, -1, 0.5}, Easing::smooth);
    EXPECT_NEAR(move.at(0).azimuth_rad, 0, 1e-12);
    EXPECT_NEAR(move.at(1).azimuth_rad, 1, 1e-12);
    EXPECT_NEAR(move.at(2).azimuth_rad, -1, 1e-12);
    EXPECT_NEAR(move.at(3).azimuth_rad, 0.5, 1e-12);
}

TEST(Move, HoldsItsEndsBeyondThem) {
    const Move move = move_of({0.3, 1, 2}, Easing::smooth);
    EXPECT_EQ(move.at(-5).azimuth_rad, 0.3);
    EXPECT_EQ(move.at(50).azimuth_rad, 2);
}

TEST(Move, SpeedIsContinuousAtASmoothKeyframe) {
    const Move move = move_of({0, 1, -1, 0.5}, Easing::smooth);
    // Catmull-Rom: the speed at a keyframe is the slope between its neighbours.
    EXPECT_NEAR(speed(move, 1 - 1e-4), -0.5, 1e-2);
    EXPECT_NEAR(speed(move, 1 + 1e-4), -0.5, 1e-2);
    EXPECT_NEAR(speed(move, 2 - 1e-4), -0.25, 1e-2);
    EXPECT_NEAR(speed(move, 2 + 1e-4), -0.25, 1e-2);
}

TEST(Move, ReproducesAParabolaAtUnevenTimes) {
    std::vector<MoveKeyframe> keyframes;
    for (const double t : {0.0, 0.7, 2.0, 2.5, 4.0})
        keyframes.push_back({t, looking_down(0.1 * t * t), Easing::smooth});
    const Move move(keyframes, false);
    for (const double t : {0.7, 1.1, 1.9, 2.2, 2.5})  // between keyframes that have two neighbours
        EXPECT_NEAR(move.at(t).azimuth_rad, 0.1 * t * t, 1e-12);
}

TEST(Move, RunsAtConstantSpeedWhenLinear) {
    const Move move = move_of({0, 1, 3}, Easing::linear);
    EXPECT_NEAR(move.at(0.25).azimuth_rad, 0.25, 1e-12);
    EXPECT_NEAR(move.at(1.75).azimuth_rad, 2.5, 1e-12);
}

TEST(Move, EasesFromRestToRest) {
    const Move move = move_of({0, 1, 3}, Easing::ease);
    EXPECT_NEAR(move.at(0.5).azimuth_rad, 0.5, 1e-12);
    EXPECT_NEAR(move.at(0.25).azimuth_rad, 0.15625, 1e-12);
    EXPECT_NEAR(speed(move, 1), 0, 1e-3);
}

TEST(Move, CutsAtTheNextKeyframe) {
    const Move move = move_of({0, 1, 3}, Easing::cut);
    EXPECT_EQ(move.at(0.999).azimuth_rad, 0);
    EXPECT_EQ(move.at(1).azimuth_rad, 1);
    EXPECT_EQ(move.at(2).azimuth_rad, 3);
}

TEST(Move, DolliesByEqualFactorsInEqualTimes) {
    const Move move(
        {{0, looking_down(0, 2), Easing::linear}, {1, looking_down(0, 8), Easing::linear}}, false);
    EXPECT_NEAR(move.at(0.5).distance_m, 4, 1e-12);
}

TEST(Move, LoopsWithoutASeam) {
    const double turn = 2 * std::numbers::pi;
    const Move move = move_of({0, turn / 4, turn / 2, turn}, Easing::smooth, true);
    EXPECT_NEAR(std::remainder(move.at(3.5).azimuth_rad - move.at(0.5).azimuth_rad, turn), 0, 1e-9);
    // Three-point slope over the seam: half a turn before it, a quarter after it, in 2 s.
    EXPECT_NEAR(speed(move, 3 - 1e-4), 0.375 * turn, 1e-2);
    EXPECT_NEAR(speed(move, 1e-4), 0.375 * turn, 1e-2);
}

TEST(Move, StaysAboveTheFloorWhereTheCurveOvershoots) {
    std::vector<MoveKeyframe> keyframes;
    for (const double elevation : {0.8, -0.18, -0.18, 0.8}) {
        OrbitView view;
        view.elevation_rad = elevation;
        view.distance_m = 5;
        keyframes.push_back({static_cast<double>(keyframes.size()), view, Easing::smooth});
    }
    const Move move(keyframes, false);
    for (double t = 0; t < 3; t += 0.05)
        EXPECT_GE(move.at(t).eye_m().y(), FlightLimits().min_eye_height_m - 1e-12) << t;
}

OrbitView free_view(const Eigen::Vector3d& eye_m, double pan_rad, double tilt_rad,
                    double roll_rad) {
    CameraState camera;
    camera.world_from_camera.linear() = turned({pan_rad, tilt_rad, roll_rad});
    camera.world_from_camera.translation() = eye_m;
    return orbit_view_of(camera);
}

Move free_move(Easing easing) {
    return {{{0, free_view({0, 1, 4}, 0, 0, 0), easing},
             {1, free_view({1, 2, 4}, 0.6, -1.2, 0.2), easing},
             {3, free_view({4, 2, 0}, 1.9, -M_PI / 2, -0.4), easing},
             {4, free_view({4, 1, -1}, 3.0, 0.4, 0), easing}},
            false,
            {},
            MovePath::free};
}

TEST(FreeMove, PassesThroughEveryKeyframeAlsoStraightDown) {
    for (const Easing easing : {Easing::smooth, Easing::linear, Easing::ease, Easing::cut}) {
        const Move move = free_move(easing);
        for (const MoveKeyframe& keyframe : move.keyframes())
            EXPECT_TRUE(move.at(keyframe.time_s)
                            .world_from_camera()
                            .isApprox(keyframe.view.world_from_camera(), 1e-6))
                << keyframe.time_s;
    }
}

TEST(FreeMove, SpeedAndTurnRateAreContinuous) {
    const Move move = free_move(Easing::smooth);
    constexpr double h = 1e-4;
    const auto speeds = [&](double time_s) {
        const Pose a = move.at(time_s).world_from_camera();
        const Pose b = move.at(time_s + h).world_from_camera();
        const Eigen::AngleAxisd turn(a.linear().transpose() * b.linear());
        return std::pair<Eigen::Vector3d, Eigen::Vector3d>((b.translation() - a.translation()) / h,
                                                           turn.angle() / h * turn.axis());
    };
    for (double t = 0; t < 4 - 3 * h; t += 0.01) {
        const auto [way, turn] = speeds(t);
        const auto [next_way, next_turn] = speeds(t + h);
        EXPECT_LT((next_way - way).norm(), 0.01) << t;
        EXPECT_LT((next_turn - turn).norm(), 0.02) << t;
    }
    EXPECT_LT(speeds(0).second.norm(), 0.01) << "from rest";
}

TEST(FreeMove, TurnsAtConstantSpeedWhenLinear) {
    const Move move({{0, free_view({0, 1, 4}, 0, 0, 0), Easing::linear},
                     {1, free_view({2, 1, 4}, 1, 0, 0), Easing::linear}},
                    false, {}, MovePath::free);
    EXPECT_TRUE(move.at(0.25).world_from_camera().isApprox(
        free_view({0.5, 1, 4}, 0.25, 0, 0).world_from_camera(), 1e-9));
}

class MoveFile : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& text) {
        const std::filesystem::path path = folder_.path() / "move.toml";
        std::ofstream(path) << text;
        return path;
    }
    /// The error message for the file; empty if it is valid.
    std::string refusal(const std::string& text) {
        return thrown_sentence([&] { Move::load(write(text)); });
    }

  private:
    TemporaryFolder folder_;
};

constexpr const char* two_keyframes = R"(version = 1
[[keyframe]]
time_s = 0
azimuth_deg = 10
elevation_deg = 5
distance_m = 3
field_of_view_deg = 40
[[keyframe]]
time_s = 2
azimuth_deg = 370
)";

TEST_F(MoveFile, KeyframesInheritOmittedValues) {
    const Move move = Move::load(write(two_keyframes));
    EXPECT_EQ(move.duration_s(), 2);
    EXPECT_FALSE(move.loops());
    const OrbitView end = move.at(2);
    EXPECT_NEAR(end.azimuth_rad, 370 * deg, 1e-12);
    EXPECT_NEAR(end.elevation_rad, 5 * deg, 1e-12);
    EXPECT_NEAR(end.distance_m, 3, 1e-12);
    EXPECT_NEAR(end.field_of_view_rad, 40 * deg, 1e-12);
}

TEST_F(MoveFile, ReadsEyeAndTarget) {
    const Move move = Move::load(write(R"(version = 1
[[keyframe]]
time_s = 0
eye_m = [3, 1, 0]
target_m = [0, 1, 0]
[[keyframe]]
time_s = 1
eye_m = [0, 1, -3]
)"));
    EXPECT_NEAR(move.at(0).azimuth_rad, 90 * deg, 1e-12);
    EXPECT_NEAR(move.at(1).azimuth_rad, 180 * deg, 1e-12);
    EXPECT_TRUE(move.at(1).eye_m().isApprox(Eigen::Vector3d(0, 1, -3)));
    EXPECT_NEAR(move.at(0.5).distance_m, 3, 1e-12) << "an orbit, not the chord";
}

TEST_F(MoveFile, LoopsOverWholeTurns) {
    const Move move = Move::load(write("loop = true\n" + std::string(two_keyframes)));
    EXPECT_TRUE(move.loops());
}

TEST_F(MoveFile, RejectsInvalidValuesWithFileLineAndReason) {
    const std::string head = "version = 1\n";
    const std::string first = "[[keyframe]]\ntime_s = 0\n", second = "[[keyframe]]\ntime_s = 1\n";
    const struct {
        std::string text, line, reason;
    } cases[] = {
        {head + first + "azimut_deg = 3\n" + second, ":4:", "azimuth_deg"},
        {head + first + "azimuth_deg = \"left\"\n" + second, ":4:", "number"},
        {head + first + second + "easing = \"bounce\"\n", ":6:", "bounce"},
        {head + first + "[[keyframe]]\ntime_s = 0\n", ":5:", "later"},
        {head + "[[keyframe]]\ntime_s = 1\n" + second, ":3:", "must be 0"},
        {head + first + "elevation_deg = -40\n" + second, ":3:", "floor"},
        {head + first + "eye_m = [1, 2, 3]\nazimuth_deg = 4\n" + second, ":5:", "eye_m"},
        {head + first + "target_m = [1, 2, 3]\n" + second, ":", "eye_m"},
        {head + first + "eye_m = [0, 1, 0]\n" + second, ":4:", "same point as target_m"},
        {head + first + "distance_m = 0.01\n" + second, ":4:", "0.02"},
        {head + "loop = true\n" + first + "azimuth_deg = 5\n" + second + "azimuth_deg = 6\n",
         ":2:", "first"},
        {"version = 2\n" + first + second, ":1:", "version"},
    };
    for (const auto& c : cases) {
        const std::string sentence = refusal(c.text);
        EXPECT_NE(sentence.find("move.toml" + c.line), std::string::npos) << sentence;
        EXPECT_NE(sentence.find(c.reason), std::string::npos) << sentence << "\n" << c.text;
    }
}

TEST_F(MoveFile, SuppliedMovesAreValid) {
    for (const char* name : {"demo.toml", "freeze.toml", "pair.toml", "sweep.toml"}) {
        const Move move = Move::load(source_folder() / "hw_config/moves" / name);
        EXPECT_GT(move.duration_s(), 5) << name;
    }
}

Move three_keyframes() { return {{{0, looking(0)}, {2, looking(1)}, {5, looking(2)}}, false}; }

std::vector<double> times(const Move& move) {
    std::vector<double> times;
    for (const MoveKeyframe& keyframe : move.keyframes()) times.push_back(keyframe.time_s);
    return times;
}

TEST(MoveEdit, StartsWithOneKeyframe) {
    const Move move = appended(std::nullopt, looking(0.5), {}, 3, {});
    EXPECT_EQ(move.duration_s(), 0);
    EXPECT_EQ(move.at(7).azimuth_rad, 0.5);
    EXPECT_EQ(times(appended(move, looking(1), {}, 3, {})), (std::vector<double>{0, 3}));
}

TEST(MoveEdit, TakesItsTimesFromTheTakeWhilePlaybackMoves) {
    Move move = appended(std::nullopt, looking(0), 10.0, 3, {});
    move = appended(move, looking(1), 14.5, 3, {});
    move = appended(move, looking(2), 14.5, 3, {});
    EXPECT_EQ(times(move), (std::vector<double>{0, 4.5, 7.5}));
    EXPECT_NEAR(*move.take_s_at(2.25), 12.25, 1e-12);
    EXPECT_EQ(*move.take_s_at(6), 14.5) << "playback is frozen while the camera flies on";
    move = appended(move, looking(3), {}, 3, {});
    EXPECT_EQ(*move.take_s_at(100), 14.5) << "the last position stays";
}

TEST(MoveEdit, ReplacesAKeyframeOrInsertsOne) {
    const Move replaced = with_view_at(three_keyframes(), 2.01, looking(7), {});
    EXPECT_EQ(times(replaced), (std::vector<double>{0, 2, 5}));
    EXPECT_NEAR(replaced.at(2).azimuth_rad, 7 - 2 * M_PI, 1e-12) << "the shorter way round";
    const Move between = with_view_at(three_keyframes(), 3, looking(1.2), {});
    EXPECT_EQ(times(between), (std::vector<double>{0, 2, 3, 5}));
    EXPECT_NEAR(between.at(3).azimuth_rad, 1.2, 1e-12);
}

TEST(MoveEdit, RemovesKeyframesDownToTheLast) {
    const Move without_first = *without_keyframe(three_keyframes(), 0);
    EXPECT_EQ(times(without_first), (std::vector<double>{0, 3}))
        << "the move starts at its second keyframe";
    EXPECT_EQ(without_first.at(0).azimuth_rad, 1);
    EXPECT_FALSE(without_keyframe(*without_keyframe(without_first, 1), 0));
}

TEST(MoveEdit, ShiftsAKeyframeAndAllLaterOnes) {
    EXPECT_EQ(times(retimed(three_keyframes(), 1, 1.5)), (std::vector<double>{0, 3.5, 6.5}));
    const Move earlier = retimed(three_keyframes(), 2, -10);
    EXPECT_GT(earlier.duration_s(), 2);
    EXPECT_LT(earlier.duration_s(), 2.1);
    EXPECT_EQ(times(retimed(three_keyframes(), 0, 1)), (std::vector<double>{0, 2, 5}));
}

TEST(MoveEdit, LoopsWhileBothEndsShowTheSameView) {
    const Move loop({{0, looking(0)}, {2, looking(1)}, {5, looking(2 * M_PI)}}, true);
    EXPECT_TRUE(retimed(loop, 1, 1).loops());
    EXPECT_TRUE(with_view_at(loop, 1, looking(0.5), {}).loops());
    EXPECT_FALSE(appended(loop, looking(3), {}, 3, {}).loops());
}

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

#include "host_app/flight/camera_pair.h"

#include <gtest/gtest.h>

#include "tests/unit/host_app/flight/looking.h"

namespace vantage {
namespace {

class CameraPairTest : public testing::Test {
  protected:
    static std::optional<OrbitView> no_rig(int) { return std::nullopt; }
    /// Turns by 1 rad in 10 s.
    static Move slow_move() {
        return Move({{0, looking(0), Easing::linear}, {10, looking(1), Easing::linear}}, false);
    }
    void pass(double seconds) {
        for (double t = 0; t < seconds - 1e-9; t += 0.02) cameras_.advance(0.02);
    }
    void operator_input(const FlightInput& input) {
        cameras_.in_hand().flight_controller.take(input, no_rig);
    }
    double on_air() const { return cameras_.programme().flight_controller.view().azimuth_rad; }
    double on_preview() const { return cameras_.preview()->flight_controller.view().azimuth_rad; }
    /// Flies the camera on preview to 0.5 rad, where it rests.
    void fly_preview_away() {
        cameras_.toggle_preview();
        operator_input({.orbit_azimuth_rad = 0.5});
        pass(3);
    }

    CameraPair cameras_{FlightController(looking(0), {})};
};

TEST_F(CameraPairTest, OperatorFliesTheProgrammeUnlessThereIsAPreview) {
    EXPECT_EQ(cameras_.preview(), nullptr);
    operator_input({.orbit_azimuth_rad = 0.2});
    pass(3);
    EXPECT_NEAR(on_air(), 0.2, 1e-6);
    cameras_.toggle_preview();
    EXPECT_NEAR(on_preview(), 0.2, 1e-6) << "it starts at the programme's view";
    operator_input({.orbit_azimuth_rad = 0.3});
    pass(3);
    EXPECT_NEAR(on_preview(), 0.5, 1e-6);
    EXPECT_NEAR(on_air(), 0.2, 1e-6);
    cameras_.toggle_preview();
    EXPECT_EQ(cameras_.preview(), nullptr);
    operator_input({.orbit_azimuth_rad = -0.1});
    pass(3);
    EXPECT_NEAR(on_air(), 0.1, 1e-6);
}

TEST_F(CameraPairTest, CutSwapsBothCamerasAtOnce) {
    fly_preview_away();
    cameras_.cut();
    EXPECT_NEAR(on_air(), 0.5, 1e-6);
    EXPECT_NEAR(on_preview(), 0, 1e-6);
    operator_input({.orbit_azimuth_rad = -0.3});
    pass(3);
    EXPECT_NEAR(on_air(), 0.5, 1e-6) << "the operator flies the camera that is on preview now";
    cameras_.cut();
    EXPECT_NEAR(on_air(), -0.3, 1e-6);
    EXPECT_NEAR(on_preview(), 0.5, 1e-6);
}

TEST_F(CameraPairTest, FlightToPreviewKeepsItsDurationWhileTheOperatorFlies) {
    fly_preview_away();
    cameras_.fly_to_preview(2);
    EXPECT_NEAR(*cameras_.fly_progress(), 0, 1e-9);
    operator_input({.orbit_azimuth_rad = 0.4});
    double last = on_air(), fastest = 0;
    for (int i = 0; i < 50; ++i) {
        pass(0.02);
        fastest = std::max(fastest, on_air() - last);
        last = on_air();
    }
    EXPECT_NEAR(on_air(), 0.25, 1e-6) << "half of the way in half of the time";
    EXPECT_NEAR(*cameras_.fly_progress(), 0.5, 1e-6);
    EXPECT_LT(fastest, 0.0076) << "no jump: 0.005 on average, 1.5 times as much in the middle";
    pass(1.5);
    EXPECT_NEAR(on_air(), 0.5, 1e-6) << "the view of the preview when the flight started";
    EXPECT_FALSE(cameras_.fly_progress());
    EXPECT_NEAR(on_preview(), 0.9, 1e-3) << "the operator still flies it";
}

TEST_F(CameraPairTest, CutEndsAFlightToThePreview) {
    fly_preview_away();
    cameras_.fly_to_preview(2);
    pass(1);
    cameras_.cut();
    EXPECT_NEAR(on_air(), 0.5, 1e-6);
    EXPECT_FALSE(cameras_.fly_progress());
    pass(3);
    EXPECT_NEAR(on_preview(), 0.25, 1e-6) << "where the cut stopped it";
}

TEST_F(CameraPairTest, CutTakesRunningMovesAlong) {
    CameraPair cameras{FlightController(looking(0), slow_move())};
    const auto pass_both = [&](double seconds) {
        for (double t = 0; t < seconds - 1e-9; t += 0.02) cameras.advance(0.02);
    };
    pass_both(2);
    cameras.toggle_preview();
    cameras.in_hand().flight_controller.take({.orbit_elevation_rad = 0.1}, no_rig);
    pass_both(3);
    EXPECT_NEAR(cameras.programme().flight_controller.view().azimuth_rad, 0.5, 1e-6)
        << "input does not move it";
    EXPECT_NEAR(cameras.preview()->flight_controller.view().azimuth_rad, 0.2, 1e-6);
    cameras.cut();
    pass_both(1);
    EXPECT_NEAR(cameras.programme().flight_controller.view().azimuth_rad, 0.2, 1e-6);
    EXPECT_NEAR(cameras.preview()->flight_controller.view().azimuth_rad, 0.6, 1e-6)
        << "the move goes on there";
    cameras.cut();
    pass_both(1);
    EXPECT_NEAR(cameras.programme().flight_controller.view().azimuth_rad, 0.7, 1e-6)
        << "and on air again";
    EXPECT_TRUE(cameras.programme().flight_controller.move_progress());
}

TEST_F(CameraPairTest, BothCamerasTakeChangesOfShotsAndMove) {
    fly_preview_away();
    operator_input({.commands = {command::StoreShot{3}}});
    operator_input({.commands = {command::AddKeyframe{}}});
    const auto change = cameras_.take_change();
    ASSERT_TRUE(change);
    EXPECT_TRUE(change->is_of_move);
    EXPECT_EQ(cameras_.programme().flight_controller.keyframes(), 1u);
    cameras_.programme().flight_controller.take({.commands = {command::RecallShot{3}}}, no_rig);
    pass(3);
    EXPECT_NEAR(on_air(), 0.5, 1e-6);
    EXPECT_FALSE(cameras_.take_change()) << "reported once";
}

TEST_F(CameraPairTest, MoveOnAirKeepsItsOldVersionUntilTheOperatorFliesIt) {
    CameraPair cameras{FlightController(looking(0), slow_move())};
    cameras.toggle_preview();
    FlightController& in_hand = cameras.in_hand().flight_controller;
    in_hand.take({.commands = {command::ToggleMove{}}}, no_rig);
    in_hand.take({.commands = {command::AddKeyframe{}}}, no_rig);
    ASSERT_TRUE(cameras.take_change());
    EXPECT_EQ(cameras.in_hand().flight_controller.keyframes(), 3u);
    cameras.advance(0.02);
    EXPECT_EQ(cameras.programme().flight_controller.keyframes(), 2u);
    cameras.toggle_preview();
    EXPECT_EQ(cameras.programme().flight_controller.keyframes(), 3u);
}

TEST_F(CameraPairTest, CamerasKeepTheirNumbersAcrossCuts) {
    const std::uint64_t first = cameras_.programme().id;
    cameras_.toggle_preview();
    const std::uint64_t second = cameras_.preview()->id;
    EXPECT_NE(first, second);
    cameras_.cut();
    EXPECT_EQ(cameras_.find(first), cameras_.preview());
    EXPECT_EQ(cameras_.find(second), &cameras_.programme());
    cameras_.toggle_preview();
    EXPECT_EQ(cameras_.find(first), nullptr);
    cameras_.toggle_preview();
    EXPECT_NE(cameras_.preview()->id, first);
}

}  // namespace
}  // namespace vantage

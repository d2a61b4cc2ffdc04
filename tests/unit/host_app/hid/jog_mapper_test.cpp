#include "host_app/control/hid/jog_mapper.h"

#include <numbers>

#include <gtest/gtest.h>

#include "tests/unit/host_app/flight/given_commands.h"
#include "tests/unit/host_app/hid/decoded.h"

namespace vantage {
namespace {

constexpr double deg = std::numbers::pi / 180;

class JogMapperTest : public testing::Test {
  protected:
    JogMapperTest() {
        const auto turns = [](const char* name) {
            return AxisMap{.action = AxisAction::command, .command = find_command(name)};
        };
        profile_->axes = {{"jog", turns("wheel")},
                          {"ring", {.action = AxisAction::shuttle}},
                          {"dial", turns("orbit")},
                          {"x", turns("pan_right")}};
        profile_->axes["dial"].sensitivity = 2;
        profile_->axes["dial"].inverted = true;
        profile_->axes["x"].dead_zone = 0.2;
        profile_->buttons = {{"b2", {ButtonAction::store_next, {}}}, {"b8", {}}};
        for (const auto& [button, words] : {std::pair("b1", "shot 3"),
                                            {"b3", "freeze"},
                                            {"b4", "mode"},
                                            {"b5", "play"},
                                            {"b6", "reset"},
                                            {"b7", "synthesiser"},
                                            {"b10", "live"},
                                            {"in", "mark_in"},
                                            {"out", "mark_out"},
                                            {"none", "no_marks"},
                                            {"loop", "loop"},
                                            {"cue", "cue"},
                                            {"slower", "slower"},
                                            {"faster", "faster"}})
            profile_->buttons[button] = {ButtonAction::command, *parse_button_command(words)};
    }
    void take(const JogEvent& event, const char* path = "/dev/hidraw0") {
        mapper_.take({DeckEvent::Kind::control, path, profile_, event, {}, {}});
    }
    FlightInput push(const char* button) {
        take(press(button));
        take(let_go(button));
        return mapper_.input(0.1);
    }

    std::shared_ptr<WheelProfile> profile_ = std::make_shared<WheelProfile>();
    JogMapper mapper_;
};

TEST_F(JogMapperTest, BendsAnAxisAlongItsCurve) {
    profile_->axes["x"].curve = 2;
    const AxisMap& map = profile_->axes["x"];
    EXPECT_EQ(response_of(map, 0.1), 0) << "in its dead zone";
    EXPECT_NEAR(response_of(map, 0.6), 0.25, 1e-12) << "half of its way";
    EXPECT_NEAR(response_of(map, -0.6), -0.25, 1e-12);
    EXPECT_EQ(response_of(map, 1), 1);
    take({JogKind::axis, "x", 0.6});
    const double bent = mapper_.input(0.1).pan_right_widths;
    profile_->axes["x"].curve = 1;
    take({JogKind::axis, "x", 0.6});
    EXPECT_NEAR(bent, 0.5 * mapper_.input(0.1).pan_right_widths, 1e-12);
}

TEST_F(JogMapperTest, LetsGoOfWhatIsHeld) {
    take({JogKind::axis, "x", 1});
    take(press("b2"));
    mapper_.let_go();
    EXPECT_FALSE(mapper_.is_storing());
    EXPECT_EQ(mapper_.input(0.1).pan_right_widths, 0);
}

TEST_F(JogMapperTest, AddsUpStepsAndGivesThemOnce) {
    take(step("jog", 2));
    take(step("jog", -5));
    EXPECT_EQ(mapper_.input(0.1).wheel_steps, -3);
    EXPECT_EQ(mapper_.input(0.1).wheel_steps, 0);
}

TEST_F(JogMapperTest, KeepsAHeldRingGoingUntilItIsLetGo) {
    take(axis("ring", -3.0 / 7));
    EXPECT_NEAR(mapper_.input(0.1).shuttle_s, -0.033, 1e-12);
    EXPECT_NEAR(mapper_.input(0.2).shuttle_s, -0.066, 1e-12);
    take(axis("ring", 0));
    EXPECT_EQ(mapper_.input(0.2).shuttle_s, 0);
}

TEST_F(JogMapperTest, AppliesSensitivityAndInversion) {
    take(step("dial", 3));
    EXPECT_NEAR(mapper_.input(0.1).orbit_azimuth_rad, -6 * deg, 1e-12);
}

TEST_F(JogMapperTest, RestsWithinTheDeadZoneAndReachesTheEnd) {
    take(axis("x", 0.2));
    EXPECT_EQ(mapper_.input(1).pan_right_widths, 0);
    take(axis("x", 0.6));
    const double half = mapper_.input(1).pan_right_widths;
    take(axis("x", 1));
    EXPECT_NEAR(mapper_.input(1).pan_right_widths, 2 * half, 1e-12);
    take(axis("x", -0.1));
    EXPECT_EQ(mapper_.input(1).pan_right_widths, 0);
}

TEST_F(JogMapperTest, TurnsButtonsIntoRequests) {
    EXPECT_EQ(number_of<command::RecallShot>(push("b1")), 3);
    EXPECT_TRUE(push("b3").find<command::ToggleHold>());
    EXPECT_TRUE(push("b4").find<command::NextWheelMode>());
    EXPECT_TRUE(push("b5").find<command::ToggleMove>());
    EXPECT_TRUE(push("b6").find<command::ResetView>());
    EXPECT_TRUE(push("b10").find<command::ToLive>());
    EXPECT_TRUE(push("b7").find<command::NextSynthesiser>());
    EXPECT_TRUE(push("in").find<command::MarkIn>());
    EXPECT_TRUE(push("out").find<command::MarkOut>());
    EXPECT_TRUE(push("none").find<command::ClearMarks>());
    EXPECT_TRUE(push("loop").find<command::ToggleLoop>());
    EXPECT_TRUE(push("cue").find<command::CueIn>());
    EXPECT_EQ(speed_steps(push("slower")), -1);
    EXPECT_EQ(speed_steps(push("faster")), 1);
    const FlightInput nothing = push("b8");
    EXPECT_FALSE(nothing.steers() || nothing.find<command::ToggleHold>() || nothing.turns_wheel());
}

TEST_F(JogMapperTest, StoresTheShotThatFollowsTheStoreButton) {
    push("b2");
    EXPECT_TRUE(mapper_.is_storing());
    const FlightInput stored = push("b1");
    EXPECT_EQ(number_of<command::StoreShot>(stored), 3);
    EXPECT_EQ(number_of<command::RecallShot>(stored), 0);
    EXPECT_EQ(number_of<command::RecallShot>(push("b1")), 3);
    push("b2");
    push("b2");
    EXPECT_EQ(number_of<command::RecallShot>(push("b1")), 3) << "pressed twice it is off again";
}

TEST_F(JogMapperTest, ForgetsOnlyTheWheelThatIsLost) {
    take(axis("ring", 1), "/dev/hidraw0");
    take(axis("ring", 1), "/dev/hidraw1");
    EXPECT_NEAR(mapper_.input(1).shuttle_s, 4, 1e-12);
    mapper_.take({DeckEvent::Kind::lost, "/dev/hidraw0", profile_, {}, {}, {}});
    EXPECT_NEAR(mapper_.input(1).shuttle_s, 2, 1e-12);
}

TEST_F(JogMapperTest, LeavesControlsAloneThatTheProfileDoesNotName) {
    take(step("other", 7));
    take(axis("another", 1));
    take(press("b9"));
    const FlightInput input = mapper_.input(1);
    EXPECT_FALSE(input.steers() || input.turns_wheel());
}

TEST(ShuttleSpeed, GivesTheSpeedsThatOperatorsKnow) {
    constexpr double speeds[] = {0, 0.1, 0.25, 0.33, 0.5, 0.75, 1, 2};
    for (int notch = 0; notch <= 7; ++notch) {
        EXPECT_NEAR(shuttle_speed(notch / 7.0), speeds[notch], 1e-12);
        EXPECT_NEAR(shuttle_speed(-notch / 7.0), -speeds[notch], 1e-12);
    }
    EXPECT_NEAR(shuttle_speed(6.5 / 7), 1.5, 1e-12);
}

}  // namespace
}  // namespace vantage

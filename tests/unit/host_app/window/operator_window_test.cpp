#include "host_app/desk/windows/operator_window.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <optional>
#include <thread>

#include <gtest/gtest.h>

#include "common/gl/objects/texture.h"
#include "tests/support/child_program.h"
#include "tests/support/virtual_screen.h"
#include "tests/unit/host_app/flight/given_commands.h"

namespace vantage {
namespace {

constexpr int width_px = 640, height_px = 480;
constexpr double pi = std::numbers::pi;

class OperatorInput : public testing::Test {
  protected:
    void SetUp() override {
        if (!VirtualScreen::is_there()) GTEST_SKIP() << "SKIPPED: Xvfb or xdotool is not installed";
        screen_.emplace(width_px, height_px);
        setenv("DISPLAY", screen_->display().c_str(), 1);
        unsetenv("WAYLAND_DISPLAY");
        window_.emplace("Vantage", width_px, height_px);
        look(0);
        // There is no window manager that would give it the keyboard.
        screen_->operator_input(
            {"search", "--sync", "--name", "Vantage", "windowfocus", "mousemove", "320", "240"});
        // Show the picture alone, so that it is as wide as the window.
        after({"key", "Tab"});
    }

    /// Collects the input over a few pictures, since the server delivers events with a delay.
    FlightInput look(double dt_s, int pictures = 6) {
        FlightInput all;
        for (int i = 0; i < pictures; ++i) {
            all.add(window_->poll(dt_s / pictures));
            if (const auto pulse = window_->take_seek()) sought_ = pulse;
            window_->show(state_);
        }
        return all;
    }
    void show_the_desk() { after({"key", "Tab"}); }
    static std::vector<std::string> move_into(const DeskRect& rect, double share = 0.5) {
        return {"mousemove", std::to_string(cvRound(rect.left + share * rect.width)),
                std::to_string(cvRound(rect.top + 0.3 * rect.height))};
    }
    FlightInput after(const std::vector<std::string>& commands, double dt_s = 0) {
        screen_->operator_input(commands);
        return look(dt_s);
    }

    std::optional<VirtualScreen> screen_;
    std::optional<OperatorWindow> window_;
    DeskState state_;
    std::optional<double> sought_;
};

TEST_F(OperatorInput, LeftDragOrbits) {
    after({"mousedown", "1"});
    const FlightInput input = after({"mousemove", "384", "192"});
    EXPECT_NEAR(input.orbit_azimuth_rad, -0.1 * pi, 1e-6) << "a tenth of the width";
    EXPECT_NEAR(input.orbit_elevation_rad, -48.0 / 640 * pi, 1e-6);
    EXPECT_TRUE(input.steers());
    after({"mouseup", "1"});
    EXPECT_FALSE(after({"mousemove", "320", "240"}).steers()) << "the button is up";
}

TEST_F(OperatorInput, ADragBetweenTwoPicturesCountsOnlyWhileTheButtonIsDown) {
    const FlightInput input = after({"mousemove", "360", "300", "mousedown", "1", "mousemove",
                                     "424", "300", "mouseup", "1", "mousemove", "320", "240"});
    EXPECT_NEAR(input.orbit_azimuth_rad, -0.1 * pi, 1e-6);
    EXPECT_EQ(input.orbit_elevation_rad, 0);
}

TEST_F(OperatorInput, WithAPreviewInputFliesThePreview) {
    state_.preview.emplace();
    look(0);
    ASSERT_TRUE(window_->drawn().preview);
    const auto drag_in = [&](const DeskRect& picture) {
        after(move_into(picture));
        after({"mousedown", "1"});
        const FlightInput input = after({"mousemove_relative", "--", "32", "0"});
        after({"mouseup", "1"});
        return input.orbit_azimuth_rad;
    };
    EXPECT_NEAR(drag_in(*window_->drawn().preview), -32 * pi / window_->drawn().preview->width,
                1e-4);
    EXPECT_EQ(drag_in(window_->drawn().picture), 0) << "what is on air is not touched";
    EXPECT_TRUE(after({"key", "slash"}).find<command::TogglePreview>());
    EXPECT_TRUE(after({"key", "semicolon"}).find<command::Cut>());
    EXPECT_TRUE(after({"key", "apostrophe"}).find<command::FlyToPreview>());
}

TEST_F(OperatorInput, RightAndMiddleDragShift) {
    for (const char* button : {"3", "2"}) {
        after({"mousedown", button});
        const FlightInput input = after({"mousemove", "384", "272"});
        EXPECT_NEAR(input.pan_right_widths, -0.1, 1e-6) << button;
        EXPECT_NEAR(input.pan_up_widths, 0.05, 1e-6) << button;
        EXPECT_EQ(input.orbit_azimuth_rad, 0) << button;
        after({"mouseup", button, "mousemove", "320", "240"});
    }
}

TEST_F(OperatorInput, WheelMovesNearerAndWithControlZooms) {
    EXPECT_NEAR(after({"click", "4"}).dolly, 0.12, 1e-6);
    EXPECT_NEAR(after({"click", "5", "click", "5"}).dolly, -0.24, 1e-6);
    after({"keydown", "Control_L"});
    const FlightInput zoomed = after({"click", "4"});
    EXPECT_NEAR(zoomed.zoom, 0.12, 1e-6);
    EXPECT_EQ(zoomed.dolly, 0);
    after({"keyup", "Control_L"});
}

TEST_F(OperatorInput, HeldKeysActAsLongAsTheyAreHeld) {
    const struct {
        const char* key;
        double FlightInput::*amount;
        double in_a_second;
    } keys[] = {{"Right", &FlightInput::orbit_azimuth_rad, 0.9},
                {"Left", &FlightInput::orbit_azimuth_rad, -0.9},
                {"Up", &FlightInput::orbit_elevation_rad, 0.9},
                {"d", &FlightInput::pan_right_widths, 0.35},
                {"q", &FlightInput::pan_up_widths, -0.35},
                {"w", &FlightInput::dolly, 0.8},
                {"minus", &FlightInput::zoom, -0.6}};
    for (const auto& k : keys) {
        after({"keydown", k.key});
        EXPECT_NEAR(look(0.5).*k.amount, 0.5 * k.in_a_second, 1e-6) << k.key;
        after({"keyup", k.key});
        EXPECT_FALSE(look(0.5).steers()) << k.key;
    }
}

TEST_F(OperatorInput, KeysAreThoseOnTheCaps) {
    const auto use_layout = [&](const char* layout) {
        return run_to_end("/usr/bin/setxkbmap", {layout}, {screen_->environment()}).status;
    };
    if (!std::filesystem::exists("/usr/bin/setxkbmap") || use_layout("fr") != 0)
        GTEST_SKIP() << "SKIPPED: setxkbmap is not installed";
    look(0);
    // xdotool presses the key whose cap has this label.
    const FlightInput input = after({"key", "m"});
    EXPECT_FALSE(input.find<command::Cut>()) << "a US keyboard has ; there";
    EXPECT_TRUE(after({"key", "semicolon"}).find<command::Cut>());
    after({"keydown", "z"});
    EXPECT_EQ(look(0.5).dolly, 0) << "a US keyboard has W there";
    after({"keyup", "z", "keydown", "w"});
    EXPECT_NEAR(look(0.5).dolly, 0.4, 1e-6);
    after({"keyup", "w"});
    EXPECT_EQ(use_layout("us"), 0);
}

TEST_F(OperatorInput, KeysGiveTheirCommands) {
    EXPECT_TRUE(after({"key", "space"}).find<command::ToggleHold>());
    EXPECT_TRUE(after({"key", "r"}).find<command::ResetView>());
    EXPECT_TRUE(after({"key", "p"}).find<command::ToggleMove>());
    EXPECT_TRUE(after({"key", "l"}).find<command::ToLive>());
    EXPECT_EQ(stepped_frames(after({"key", "comma", "key", "comma"})), -2);
    EXPECT_EQ(stepped_frames(after({"key", "period"})), 1);
    EXPECT_EQ(speed_steps(after({"key", "bracketleft", "key", "bracketleft"})), -2);
    EXPECT_EQ(speed_steps(after({"key", "bracketright"})), 1);
    EXPECT_TRUE(after({"key", "i"}).find<command::MarkIn>());
    EXPECT_TRUE(after({"key", "o"}).find<command::MarkOut>());
    EXPECT_TRUE(after({"key", "u"}).find<command::ClearMarks>());
    EXPECT_TRUE(after({"key", "b"}).find<command::ToggleLoop>());
    EXPECT_TRUE(after({"key", "Home"}).find<command::CueIn>());
    EXPECT_TRUE(after({"key", "t"}).find<command::ToggleTake>());
    EXPECT_TRUE(after({"key", "F2"}).find<command::NextSynthesiser>());
    EXPECT_EQ(number_of<command::RecallShot>(after({"key", "4"})), 4);
    const FlightInput stored = after({"key", "ctrl+3"});
    EXPECT_EQ(number_of<command::StoreShot>(stored), 3);
    EXPECT_EQ(number_of<command::RecallShot>(stored), 0);
}

TEST_F(OperatorInput, KeysOfClipsGiveReplayCommands) {
    const std::pair<const char*, ReplayAction> keys[] = {
        {"BackSpace", ReplayAction::last_cue},        {"y", ReplayAction::make_clip},
        {"ctrl+y", ReplayAction::trim_clip},          {"Next", ReplayAction::clip_step},
        {"ctrl+Prior", ReplayAction::entry_step},     {"End", ReplayAction::cue_clip},
        {"ctrl+End", ReplayAction::play_clip},        {"Insert", ReplayAction::add_entry},
        {"ctrl+Delete", ReplayAction::remove_entry},  {"ctrl+p", ReplayAction::play_list},
        {"backslash", ReplayAction::programme_speed}, {"0", ReplayAction::next_entry}};
    for (const auto& [key, action] : keys) {
        const FlightInput input = after({"key", key});
        const std::vector<ReplayCall> calls = replay_calls(input);
        ASSERT_EQ(calls.size(), 1u) << key;
        EXPECT_EQ(calls[0].action, action) << key;
    }
}

TEST_F(OperatorInput, KeysHaveNoOtherEffectWhileACommandIsTyped) {
    FlightInput input = after({"key", "Return", "type", "clip_sp"});
    input.add(after({"key", "Tab"}));
    input.add(after({"type", " 50"}));
    EXPECT_FALSE(input.is_any()) << "letters are letters";
    input = after({"key", "Return"});
    const std::vector<ReplayCall> calls = replay_calls(input);
    ASSERT_EQ(calls.size(), 1u);
    EXPECT_EQ(calls[0].action, ReplayAction::clip_speed);
    EXPECT_EQ(calls[0].number, 50);
    EXPECT_TRUE(after({"key", "l"}).find<command::ToLive>()) << "it is closed";
    after({"key", "Return", "type", "nothing"});
    EXPECT_FALSE(after({"key", "Return"}).is_any());
    after({"key", "Escape"});
    EXPECT_FALSE(window_->closed());
    after({"key", "Return", "type", "20:15:07"});
    EXPECT_EQ(after({"key", "Return"}).find<command::CueTime>()->time, "20:15:07");
}

TEST_F(OperatorInput, ADragThatStartsOnAPanelDoesNotMoveTheCamera) {
    show_the_desk();
    after({"mousemove", "40", "10"});
    after({"mousedown", "1"});
    EXPECT_FALSE(after({"mousemove", "200", "240"}).steers());
    after({"mouseup", "1"});
}

TEST_F(OperatorInput, F1ShowsTheHelpAndTabHidesThePanels) {
    const auto bright = [&] {
        look(0);
        cv::Mat1b lit;
        cv::inRange(window_->screenshot(), cv::Scalar(150, 150, 150, 0),
                    cv::Scalar(255, 255, 255, 255), lit);
        return cv::countNonZero(lit);
    };
    show_the_desk();
    const int plain = bright();
    EXPECT_GT(plain, 100) << "the panels' words";
    after({"key", "F1"});
    EXPECT_GT(bright(), plain + 500);
    const int pages = window_->drawn().help_pages;
    EXPECT_GT(pages, 1) << "the window is small";
    for (int page = 1; page <= pages; ++page) after({"key", "F1"});
    EXPECT_LT(bright(), plain + 100);
    after({"key", "Tab"});
    EXPECT_LT(bright(), plain / 2);
}

TEST_F(OperatorInput, AClickOnTheTimeLineSeeksAndADragContinues) {
    show_the_desk();
    DeskTime time;
    time.oldest = 1000;
    time.newest = 2000;
    state_.time = time;
    look(0);
    const DeskSpots spots = window_->drawn().spots;
    ASSERT_TRUE(spots.time.has_value());
    after(move_into(spots.time->rect, 0.25));
    EXPECT_FALSE(sought_.has_value()) << "the mouse only points";
    EXPECT_FALSE(after({"mousedown", "1"}).steers());
    ASSERT_TRUE(sought_.has_value());
    EXPECT_NEAR(*sought_, 1250, 4);
    after(move_into(spots.time->rect, 0.75));
    EXPECT_NEAR(*sought_, 1750, 4);
    after({"mouseup", "1"});
    after(move_into(spots.time->rect, 0.5));
    EXPECT_NEAR(*sought_, 1750, 4) << "the button is up";
    EXPECT_EQ(stepped_frames(after({"click", "4"})), 1) << "a notch is a frame";
    after(move_into(spots.live));
    EXPECT_TRUE(after({"click", "1"}).find<command::ToLive>());
}

TEST_F(OperatorInput, TurningThe3dViewDoesNotMoveTheCamera) {
    show_the_desk();
    state_.plan.emplace();
    after({"key", "ctrl+Tab"});
    const DeskRect part = window_->drawn().spots.outside;
    ASSERT_FALSE(part.is_empty());
    const OutsideEye before = window_->arrangement().switches.eye;
    after(move_into(part));
    after({"mousedown", "1"});
    EXPECT_FALSE(after({"mousemove_relative", "--", "20", "0"}).steers());
    after({"mouseup", "1"});
    EXPECT_NEAR(window_->arrangement().switches.eye.azimuth_rad,
                before.azimuth_rad - 20 * pi / part.width, 1e-4);
    EXPECT_FALSE(after({"click", "4"}).steers());
    EXPECT_NEAR(window_->arrangement().switches.eye.nearness, 0.12, 1e-6);
    after({"keydown", "Control_L", "keydown", "Up"});
    EXPECT_FALSE(look(0.5).steers());
    EXPECT_NEAR(window_->arrangement().switches.eye.elevation_rad, before.elevation_rad + 0.45,
                1e-6);
    after({"keyup", "Up", "keyup", "Control_L"});
    after({"key", "ctrl+Tab"});
    EXPECT_TRUE(window_->drawn().spots.outside.is_empty());
    EXPECT_TRUE(window_->arrangement().switches.panels) << "Tab alone is another key";
}

TEST_F(OperatorInput, ShiftAndTabHideTheRigs) {
    show_the_desk();
    EXPECT_TRUE(window_->arrangement().switches.rigs);
    after({"key", "shift+Tab"});
    EXPECT_FALSE(window_->arrangement().switches.rigs);
    EXPECT_TRUE(window_->arrangement().switches.panels);
}

TEST_F(OperatorInput, RigsMoveToTheirOwnWindow) {
    show_the_desk();
    Texture colour(TextureFormat::rgba8, 160, 120, Filter::linear);
    colour.upload(ColourImage(120, 160, cv::Vec4b(150, 60, 60, 255)));
    state_.rigs.resize(4);
    for (DeskRig& rig : state_.rigs) {
        rig.state = RigState::present;
        rig.colour = &colour;
    }
    look(0);
    EXPECT_EQ(window_->rigs_window(), nullptr);
    after({"key", "ctrl+shift+Tab"});
    ASSERT_NE(window_->rigs_window(), nullptr);
    EXPECT_TRUE(window_->arrangement().switches.rigs) << "Tab with other keys is another key";
    const auto pixels_of_rigs = [](const ColourImage& shown) {
        return std::count(shown.begin(), shown.end(), cv::Vec4b(150, 60, 60, 255));
    };
    EXPECT_GT(pixels_of_rigs(window_->rigs_window()->screenshot()), 4 * 20000);
    EXPECT_EQ(pixels_of_rigs(window_->screenshot()), 0) << "they are there in place of here";
    screen_->operator_input({"search", "--sync", "--name", "Vantage rigs", "windowfocus"});
    EXPECT_TRUE(after({"key", "p"}).find<command::ToggleMove>()) << "its keys are the desk's";
    after({"key", "ctrl+shift+Tab"});
    EXPECT_EQ(window_->rigs_window(), nullptr);
    EXPECT_TRUE(window_->arrangement().rigs_window) << "it comes back where it was";
    EXPECT_GT(pixels_of_rigs(window_->screenshot()), 4 * 1000);
}

TEST_F(OperatorInput, AnArrangementIsRestored) {
    DeskArrangement desk = window_->arrangement();
    desk.switches = {.panels = true, .rigs = false, .outside = true, .eye = {1, 0.3, 0.1}};
    desk.window = WindowPlace{30, 20, 500, 400};
    window_->arrange(desk);
    for (int i = 0; i < 100 && window_->arrangement() != desk; ++i) {
        look(0, 1);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    EXPECT_EQ(window_->arrangement(), desk);
    EXPECT_EQ(window_->screenshot().size(), cv::Size(500, 400));
    // A place outside all monitors is ignored.
    desk.window->x = 5000;
    window_->arrange(desk);
    look(0);
    EXPECT_EQ(window_->arrangement().window->x, 30);
}

TEST_F(OperatorInput, AClickOnAShotRecallsIt) {
    show_the_desk();
    state_.shots.resize(shot_places);
    state_.shots[3].name = "kept";
    look(0);
    const DeskSpots spots = window_->drawn().spots;
    ASSERT_EQ(spots.shots.size(), 1u);
    after(move_into(spots.shots[0].rect));
    EXPECT_EQ(number_of<command::RecallShot>(after({"click", "1"})), 4);
}

TEST_F(OperatorInput, ARunningTakeEndsAtTheSecondPressOnly) {
    state_.take.emplace().is_running = true;
    look(0);
    EXPECT_FALSE(after({"key", "t"}).find<command::ToggleTake>());
    EXPECT_TRUE(after({"key", "t"}).find<command::ToggleTake>());
}

TEST_F(OperatorInput, AKeyframeIsTakenOutByTheSecondPressOnly) {
    EXPECT_FALSE(after({"key", "x"}).find<command::RemoveKeyframe>());
    EXPECT_TRUE(after({"key", "x"}).find<command::RemoveKeyframe>());
}

TEST_F(OperatorInput, TheSetIsForgottenByTheSecondPressOnly) {
    EXPECT_FALSE(after({"key", "ctrl+j"}).find<command::LearnBackground>());
    EXPECT_TRUE(after({"key", "ctrl+j"}).find<command::LearnBackground>());
}

TEST_F(OperatorInput, AStoredShotIsReplacedByTheSecondPressOnly) {
    state_.shots.resize(shot_places);
    state_.shots[2].is_kept = true;
    look(0);
    EXPECT_EQ(number_of<command::StoreShot>(after({"key", "ctrl+3"})), 0);
    EXPECT_EQ(number_of<command::StoreShot>(after({"key", "ctrl+3"})), 3);
    EXPECT_EQ(number_of<command::StoreShot>(after({"key", "ctrl+4"})), 4)
        << "nothing is kept there";
}

TEST_F(OperatorInput, KeysGoToAnOpenWheelMapOnly) {
    using Action = WheelCall::Action;
    EXPECT_TRUE(after({"key", "ctrl+m"}).find<command::ToggleJogMap>());
    DeskWheel wheel;
    wheel.controls = {{DeskWheel::Kind::button, "b1", "shot 1"}};
    state_.wheel_map = wheel;
    look(0);
    const FlightInput input =
        after({"key", "t",      "key",       "a",   "key",   "k",         "key", "Return",
               "key", "ctrl+s", "mousemove", "320", "240",   "mousedown", "1",   "mousemove",
               "384", "192",    "mouseup",   "1",   "click", "4"});
    EXPECT_FALSE(input.is_any());
    EXPECT_EQ(window_->take_wheel_calls(),
              (std::vector<WheelCall>{{Action::assign, 0, "take"}, {Action::save}}));
    after({"key", "Escape"});
    EXPECT_EQ(window_->take_wheel_calls(), (std::vector<WheelCall>{{Action::close}}));
    state_.wheel_map.reset();
    look(0);
    EXPECT_FALSE(window_->closed());
    EXPECT_TRUE(after({"key", "p"}).find<command::ToggleMove>()) << "keys are the desk's again";
}

TEST_F(OperatorInput, EscapeQuitsAtTheSecondPress) {
    after({"key", "Escape"});
    EXPECT_FALSE(window_->closed()) << "the first time it asks";
    after({"key", "Escape"});
    EXPECT_TRUE(window_->closed());
}

}  // namespace
}  // namespace vantage

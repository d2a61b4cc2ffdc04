#include "host_app/desk/panels/wheel_panel.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using Key = WheelPanel::Key;
using Kind = DeskWheel::Kind;
using Action = WheelCall::Action;

class WheelPanelTest : public testing::Test {
  protected:
    WheelPanelTest() {
        wheel_.controls = {{Kind::turns, "jog", "wheel"}, {Kind::button, "b1", "shot 1"}};
        follow();
    }
    /// Passes the wheel to the panel as the desk does.
    DeskWheel follow() {
        std::optional<DeskWheel> shown = wheel_;
        shown->feel =
            wheel_.selected == 0 ? std::optional<DeskWheel::Feel>(DeskWheel::Feel()) : std::nullopt;
        panel_.follow(shown);
        return *shown;
    }
    void type(const char* letters) {
        for (const char* letter = letters; *letter; ++letter)
            panel_.type(static_cast<unsigned>(*letter));
    }

    DeskWheel wheel_;
    WheelPanel panel_;
};

TEST_F(WheelPanelTest, SelectsControls) {
    EXPECT_EQ(panel_.press(Key::down), (WheelCall{Action::select_by, 1}));
    EXPECT_EQ(panel_.press(Key::up), (WheelCall{Action::select_by, -1}));
    EXPECT_EQ(panel_.press_control(2), (WheelCall{Action::select, 0, "b1"}));
    EXPECT_EQ(panel_.press(Key::escape), WheelCall{Action::close});
}

TEST_F(WheelPanelTest, AssignsAChosenCommand) {
    wheel_.selected = 1;
    follow();
    type("mark_");
    const DeskWheel shown = follow();
    ASSERT_TRUE(shown.is_choosing);
    ASSERT_GE(shown.choices.size(), 2u);
    EXPECT_EQ(shown.choices[0].action, "mark_in");
    EXPECT_EQ(panel_.press(Key::down), std::nullopt);
    EXPECT_EQ(panel_.press(Key::enter), (WheelCall{Action::assign, 0, "mark_out"}));
    EXPECT_FALSE(follow().is_choosing);
}

TEST_F(WheelPanelTest, OffersStepCommandsForAWheelAndOthersForAButton) {
    const auto has = [](Kind kind, const std::string& action) {
        for (const DeskWheel::Choice& choice : wheel_choices(kind))
            if (choice.action == action) return true;
        return false;
    };
    EXPECT_TRUE(has(Kind::turns, "orbit"));
    EXPECT_FALSE(has(Kind::turns, "shuttle"));
    EXPECT_TRUE(has(Kind::axis, "shuttle"));
    EXPECT_FALSE(has(Kind::axis, "shot 1"));
    EXPECT_TRUE(has(Kind::button, "shot 1"));
    EXPECT_FALSE(has(Kind::button, "orbit"));
    for (const Kind kind : {Kind::turns, Kind::axis, Kind::button})
        EXPECT_TRUE(has(kind, "nothing"));
}

TEST_F(WheelPanelTest, LeavesTheMapUnchangedWithoutAChoice) {
    type("no such command");
    EXPECT_TRUE(follow().choices.empty());
    EXPECT_EQ(panel_.press(Key::enter), std::nullopt);
    EXPECT_EQ(panel_.press(Key::escape), std::nullopt) << "it closes the list, not the map";
    EXPECT_FALSE(follow().is_choosing);
}

TEST_F(WheelPanelTest, ForgetsAChoiceForAnotherControl) {
    type("orb");
    wheel_.selected = 1;
    EXPECT_FALSE(follow().is_choosing);
    EXPECT_EQ(panel_.press(Key::enter), std::nullopt) << "it opens the list";
}

TEST_F(WheelPanelTest, ChangesTheSelectedPartOfTheResponse) {
    EXPECT_EQ(panel_.press(Key::right), (WheelCall{Action::steps, 1}));
    panel_.press(Key::tab);
    panel_.press(Key::tab);
    EXPECT_EQ(follow().feel_in_hand, 2u);
    EXPECT_EQ(panel_.press(Key::left), (WheelCall{Action::curve, -1}));
    wheel_.selected = 1;
    follow();
    EXPECT_EQ(panel_.press(Key::left), std::nullopt) << "a button has no response";
}

TEST_F(WheelPanelTest, IgnoresLettersWhileTheMapIsClosed) {
    std::optional<DeskWheel> closed;
    panel_.follow(closed);
    type("orb");
    EXPECT_FALSE(panel_.is_open());
    EXPECT_FALSE(follow().is_choosing);
}

}  // namespace
}  // namespace vantage

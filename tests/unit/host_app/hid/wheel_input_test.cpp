#include "host_app/control/hid/wheel_input.h"

#include <cstdlib>

#include <gtest/gtest.h>

#include "common/base/files/atomic_file.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

using Action = WheelCall::Action;

/// A ShuttleXpress at a desk whose user has a home of his own.
class WheelInputTest : public testing::Test {
  protected:
    WheelInputTest() {
        setenv("XDG_CONFIG_HOME", home_.path().c_str(), 1);
        profile_ = std::make_shared<const WheelProfile>(
            *find_profile(load_all_wheel_profiles({}), {0x0b33, 0x0020}));
        note(DeckEvent::Kind::plugged, {});
        desk_.serve_desk();
        desk_.toggle();
    }
    ~WheelInputTest() override { unsetenv("XDG_CONFIG_HOME"); }

    /// The map that the event goes by.
    std::shared_ptr<const WheelProfile> note(DeckEvent::Kind kind, const JogEvent& jog) {
        DeckEvent event{kind, "/dev/hidraw0", profile_, jog, {}, now_};
        desk_.note(event);
        return event.profile;
    }
    std::shared_ptr<const WheelProfile> move(JogKind kind, const char* control, double value) {
        return note(DeckEvent::Kind::control, {kind, control, value});
    }
    WheelMapView view() const { return desk_.view(now_).value(); }
    WheelMapView::Control in_hand() const { return view().controls.at(view().selected); }

    TemporaryFolder home_;
    MonotonicTime now_ = MonotonicClock::now();
    std::shared_ptr<const WheelProfile> profile_;
    WheelInput desk_;
};

TEST_F(WheelInputTest, ShowsTheMapAndTakesWhatIsMovedInHand) {
    EXPECT_EQ(view().name, "Contour ShuttleXpress");
    ASSERT_EQ(view().controls.size(), 7u);
    move(JogKind::button, "b3", 1);
    EXPECT_EQ(in_hand().does, "freeze");
    EXPECT_TRUE(in_hand().is_held);
    move(JogKind::axis, "shuttle", 0.5);
    EXPECT_EQ(in_hand().control.name, "shuttle");
    EXPECT_EQ(in_hand().at, 0.5);
    move(JogKind::button, "b3", 0);
    EXPECT_EQ(in_hand().control.name, "shuttle") << "what is let go takes nothing away";
    move(JogKind::step, "jog", 2);
    move(JogKind::step, "jog", 1);
    EXPECT_EQ(in_hand().at, 3);
    EXPECT_EQ(view().turned, 3);
    now_ += std::chrono::seconds(2);
    EXPECT_EQ(view().turned, 0);
}

TEST_F(WheelInputTest, ChangesTheMapAtOnceAndSaysThatItIsNotSaved) {
    move(JogKind::button, "b2", 1);
    EXPECT_TRUE(desk_.unsaved().empty());
    desk_.obey({Action::assign, 0, "mark_in"});
    EXPECT_EQ(in_hand().does, "mark_in");
    EXPECT_TRUE(view().is_changed);
    EXPECT_EQ(desk_.unsaved(), std::vector<std::string>{"Contour ShuttleXpress"});
    EXPECT_EQ(move(JogKind::button, "b2", 0)->buttons.at("b2").call.command->name,
              std::string("mark_in"))
        << "of a device that the deck knows by the old map";
    desk_.obey({Action::assign, 0, "shot 2"});
    EXPECT_FALSE(view().is_changed) << "it is what it was";
}

TEST_F(WheelInputTest, LeavesTheMapWhereAChangeCannotBe) {
    move(JogKind::button, "b2", 1);
    desk_.obey({Action::assign, 0, "mark_inn"});
    EXPECT_EQ(in_hand().does, "shot 2");
    EXPECT_NE(view().remark.find("mark_in"), std::string::npos) << view().remark;
    desk_.obey({Action::curve, 1});
    EXPECT_NE(view().remark.find("button"), std::string::npos);
    move(JogKind::step, "jog", 1);
    desk_.obey({Action::assign, 0, "shuttle"});
    EXPECT_NE(view().remark.find("without a rest"), std::string::npos);
    desk_.obey({Action::dead_zone, 1});
    EXPECT_NE(view().remark.find("no dead zone"), std::string::npos);
    EXPECT_FALSE(view().is_changed);
}

TEST_F(WheelInputTest, ChangesHowAControlFeelsWithinLimits) {
    move(JogKind::axis, "shuttle", 0.5);
    desk_.obey({Action::dead_zone, 5});
    desk_.obey({Action::curve, 3});
    desk_.obey({Action::steps, 1});
    desk_.obey({Action::invert});
    EXPECT_NEAR(view().feel.dead_zone, 0.1, 1e-6);
    EXPECT_NEAR(view().feel.curve, 1.3, 1e-6);
    EXPECT_NEAR(view().feel.sensitivity, 1.1, 1e-6);
    EXPECT_TRUE(view().feel.inverted);
    desk_.obey({Action::dead_zone, 1000});
    desk_.obey({Action::curve, -1000});
    EXPECT_NEAR(view().feel.dead_zone, 0.9, 1e-6);
    EXPECT_NEAR(view().feel.curve, 0.2, 1e-6);
    EXPECT_EQ(view().remark, "");
}

TEST_F(WheelInputTest, SavesThePackagedMapAsTheUsersOwnWithItsComments) {
    move(JogKind::button, "b2", 1);
    desk_.obey({Action::assign, 0, "mark_in"});
    desk_.obey({Action::save});
    const std::filesystem::path file = home_.path() / "vantage/jog/shuttle_xpress.toml";
    EXPECT_EQ(view().remark, "saved in " + file.string());
    EXPECT_TRUE(desk_.unsaved().empty());
    std::string expected = profile_->text;
    expected.replace(expected.find("b2 = \"shot 2\""), 13, "b2 = \"mark_in\"");
    EXPECT_EQ(read_text_file(file, 1 << 20), expected);
    const auto profiles = load_all_wheel_profiles({});
    const WheelProfile* const next = find_profile(profiles, {0x0b33, 0x0020});
    EXPECT_EQ(action_of(*next, {JogKind::button, "b2"}), "mark_in") << "the next time";
    desk_.obey({Action::assign, 0, "live"});
    desk_.obey({Action::save});
    EXPECT_NE(read_text_file(file, 1 << 20).find("b2 = \"live\""), std::string::npos) << "again";
}

TEST_F(WheelInputTest, ReplacesNoFileThatSomebodyElseHasWritten) {
    const std::filesystem::path file = home_.path() / "vantage/jog/shuttle_xpress.toml";
    std::filesystem::create_directories(file.parent_path());
    write_text_atomically(file, "mine");
    move(JogKind::button, "b2", 1);
    desk_.obey({Action::assign, 0, "mark_in"});
    desk_.obey({Action::save});
    EXPECT_NE(view().remark.find("move it away"), std::string::npos) << view().remark;
    EXPECT_EQ(read_text_file(file, 100), "mine");
    EXPECT_TRUE(view().is_changed);
}

TEST_F(WheelInputTest, ObeysNothingWhileItIsClosed) {
    move(JogKind::button, "b2", 1);
    desk_.obey({Action::close});
    EXPECT_FALSE(desk_.view(now_));
    desk_.obey({Action::assign, 0, "mark_in"});
    EXPECT_TRUE(desk_.unsaved().empty());
}

TEST_F(WheelInputTest, HasNothingToShowWithoutAWheel) {
    WheelInput bare;
    bare.toggle();
    EXPECT_FALSE(bare.is_open()) << "there is no desk to show it, and wheels would stand still";
    bare.serve_desk();
    bare.toggle();
    bare.obey({Action::assign, 0, "mark_in"});
    ASSERT_TRUE(bare.view(now_));
    EXPECT_EQ(bare.view(now_)->name, "");
}

}  // namespace
}  // namespace vantage

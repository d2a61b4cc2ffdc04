#include "host_app/control/hid/wheel_profile.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/support/data_folder.h"
#include "tests/support/source_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/hid/decoded.h"

namespace vantage {
namespace {

using Events = std::vector<JogEvent>;

std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

constexpr const char* described = R"(version = 1
name = "Workshop"
devices = ["1209:b0b0"]
[[report]]
name = "jog"
kind = "counter"
report_id = 1
byte = 1
bits = 4
bit = 4
[[report]]
name = "ring"
kind = "axis"
report_id = 1
byte = 2
bits = 16
signed = false
centre = 512
full_scale = 500
[[report]]
name = "b"
kind = "buttons"
report_id = 2
byte = 1
bits = 12
[[report]]
name = "dial"
kind = "delta"
report_id = 2
byte = 3
[axes.jog]
action = "wheel"
[axes.ring]
action = "shuttle"
dead_zone = 0.1
sensitivity = 2
inverted = true
[buttons]
b12 = "shot 9"
)";

TEST(WheelProfile, ThoseThatComeWithVantageCoverEveryKnownModel) {
    const std::vector<WheelProfile> profiles = load_wheel_profiles();
    for (const JogFamily& family : jog_families())
        for (const JogModel& model : family.models) {
            const WheelProfile* profile = find_profile(profiles, model.id);
            ASSERT_NE(profile, nullptr) << model.name;
            EXPECT_FALSE(profile->axes.empty()) << model.name;
        }
}

TEST(WheelProfile, TheExampleOfADescribedWheelIsTaken) {
    const auto file = source_folder() / "hw_config/jog/described_wheel.toml.example";
    const WheelProfile profile = read_wheel_profile(text_of(file), file);
    EXPECT_EQ(profile.report.size(), 3u);
    EXPECT_EQ(profile.axes.at("ring").action, AxisAction::shuttle);
}

TEST(WheelProfile, ReadsMapsOfAxesAndButtons) {
    const WheelProfile profile = read_wheel_profile(described, "x.toml");
    EXPECT_EQ(profile.devices, (std::vector<JogId>{{0x1209, 0xb0b0}}));
    const AxisMap ring = profile.axes.at("ring");
    EXPECT_EQ(ring.action, AxisAction::shuttle);
    EXPECT_EQ(ring.dead_zone, 0.1);
    EXPECT_EQ(ring.sensitivity, 2);
    EXPECT_TRUE(ring.inverted);
    const ButtonMap b12 = profile.buttons.at("b12");
    ASSERT_EQ(b12.action, ButtonAction::command);
    EXPECT_STREQ(b12.call.command->name, "shot");
    EXPECT_EQ(b12.call.argument, 9);
}

TEST(DescribedWheel, ReadsCountersAxesButtonsAndDeltasFromTheirBits) {
    const auto decoder = make_described_decoder(read_wheel_profile(described, "x.toml").report);
    EXPECT_EQ(decoded(*decoder, {1, 0xef, 0x00, 0x02}), Events{}) << "where the counter starts";
    EXPECT_EQ(decoded(*decoder, {1, 0x1f, 0x00, 0x02}), Events{step("jog", 3)}) << "over its wrap";
    EXPECT_EQ(decoded(*decoder, {1, 0xf0, 0xfa, 0x02}),
              (Events{step("jog", -2), axis("ring", 0.5)}));
    EXPECT_EQ(decoded(*decoder, {1, 0xf0, 0xff, 0xff}), Events{axis("ring", 1)});
    EXPECT_EQ(decoded(*decoder, {2, 0x01, 0x08, 0xfe}),
              (Events{press("b1"), press("b12"), step("dial", -2)}));
    EXPECT_EQ(decoded(*decoder, {2, 0x00, 0xf8, 0x00}), Events{let_go("b1")});
}

TEST(DescribedWheel, RefusesShortReportsAndUnknownIds) {
    const auto decoder = make_described_decoder(read_wheel_profile(described, "x.toml").report);
    EXPECT_FALSE(takes(*decoder, {1, 0, 0}));
    EXPECT_FALSE(takes(*decoder, {2, 0xff}));
    EXPECT_EQ(decoded(*decoder, {2, 0xff}), Events{});
    EXPECT_FALSE(takes(*decoder, {3, 0, 0, 0}));
    EXPECT_FALSE(takes(*decoder, {}));
}

TEST(WheelProfile, RefusesWithFileLineAndReason) {
    const std::string head = "version = 1\nname = \"w\"\n";
    const std::string xpress = head + "devices = [\"0b33:0020\"]\n";
    const std::string field = head + "devices = [\"1209:b0b0\"]\n[[report]]\nname = \"jog\"\n";
    const struct {
        std::string text, line, reason;
    } cases[] = {
        {head, ":1:", "'devices' is missing"},
        {head + "devices = []\n", ":3:", "names no device"},
        {head + "devices = [\"0b33-0020\"]\n", ":3:", "0b33:0020"},
        {head + "devices = [\"0b33:002g\"]\n", ":3:", "0b33:0020"},
        {head + "devices = [7]\n", ":3:", "array of strings"},
        {head + "devices = [\"1209:b0b0\"]\n", ":3:", "[[report]]"},
        {xpress + "[axes.jgo]\naction = \"wheel\"\n", ":5:", "the nearest is 'jog'"},
        {xpress + "[axes.b1]\naction = \"wheel\"\n", ":5:", "is no axis of this device"},
        {xpress + "[axes.jog]\naction = \"whele\"\n", ":5:", "the nearest is 'wheel'"},
        {xpress + "[axes.jog]\naction = \"shuttle\"\n", ":5:", "'wheel'"},
        {xpress + "[axes.jog]\n", ":4:", "'action'"},
        {xpress + "[axes.jog]\naction = \"wheel\"\nspeed = 2\n", ":6:", "speed"},
        {xpress + "[axes.jog]\naction = \"wheel\"\ndead_zone = 0.95\n", ":6:", "0 to 0.9"},
        {xpress + "[axes.shuttle]\naction = \"shuttle\"\ncurve = 9\n", ":6:", "0.2 to 5"},
        {xpress + "[buttons]\nb6 = \"freeze\"\n", ":5:", "is no button of this device"},
        {xpress + "[buttons]\nb1 = \"freze\"\n", ":5:", "the nearest is 'freeze'"},
        {xpress + "[buttons]\nb1 = \"shot 10\"\n", ":5:", "shot 1"},
        {xpress + "[buttons]\nb1 = \"shot 0\"\n", ":5:", "shot"},
        {field + "kind = \"counter\"\n", ":4:", "'byte'"},
        {field + "kind = \"count\"\nbyte = 1\n", ":6:", "counter"},
        {field + "kind = \"counter\"\nbyte = 0\nreport_id = 1\n",
         ":7:", "first byte behind it is 1"},
        {field + "kind = \"counter\"\nbyte = 64\n", ":7:", "0 to 63"},
        {field + "kind = \"counter\"\nbyte = 1\nbits = 33\n", ":8:", "1 to 32"},
        {field +
             "kind = \"counter\"\nbyte = 1\n[[report]]\nname = \"jog\"\nkind = \"delta\"\nbyte = "
             "2\n",
         ":9:", "a second time"},
    };
    for (const auto& c : cases) {
        const std::string sentence =
            thrown_sentence([&] { read_wheel_profile(c.text, "wheel.toml"); });
        EXPECT_NE(sentence.find("wheel.toml" + c.line), std::string::npos) << sentence << c.text;
        EXPECT_NE(sentence.find(c.reason), std::string::npos) << sentence << '\n' << c.text;
    }
}

TEST(WheelProfile, OwnFilesComeOnTopOfTheBuiltInOnes) {
    const TemporaryFolder folder;
    std::ofstream(folder.path() / "mine.toml")
        << "version = 1\nname = \"mine\"\ndevices = [\"0b33:0020\"]\n[axes.jog]\naction = "
           "\"dolly\"\n";
    std::ofstream(folder.path() / "notes.txt") << "no wheel";
    for (const auto& own : {folder.path(), folder.path() / "mine.toml"}) {
        const std::vector<WheelProfile> profiles = load_wheel_profiles(own);
        EXPECT_EQ(find_profile(profiles, {0x0b33, 0x0020})->name, "mine");
        EXPECT_EQ(find_profile(profiles, {0x0b33, 0x0030})->name, "Contour ShuttlePRO");
        EXPECT_EQ(find_profile(profiles, {0x1234, 0x5678}), nullptr);
    }
    const TemporaryFolder empty;
    EXPECT_NE(thrown_sentence([&] { load_wheel_profiles(empty.path()); }).find("no wheel"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([&] { load_wheel_profiles(empty.path() / "x.toml"); }).find("x.toml"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage

#include "common/config/rig_config.h"

#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/source_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/common/config/config_text.h"

namespace vantage {
namespace {

using RigConfigTest = ConfigText<load_rig_config>;

TEST_F(RigConfigTest, UsesDefaultsForMissingKeys) {
    const RigConfig config = load("version = 1\nname = 'a'\n");
    EXPECT_EQ(config.name, "a");
    EXPECT_EQ(config.source.kind, "virtual");
    EXPECT_EQ(config.match.preset, "balanced");
    EXPECT_EQ(config.match.width_px, 0) << "that of the picture";
    EXPECT_EQ(config.stream.queue_frames, 4);
    EXPECT_EQ(config.stream.road, "tcp");
    EXPECT_TRUE(config.calibration.empty());
    EXPECT_FALSE(config.uncalibrated);
}

TEST_F(RigConfigTest, AcceptsNoneAsCalibration) {
    const RigConfig config = load("version = 1\nname = 'a'\ncalibration = 'none'\n");
    EXPECT_TRUE(config.uncalibrated);
    EXPECT_TRUE(config.calibration.empty());
}

TEST_F(RigConfigTest, ReadsEveryKey) {
    const RigConfig config = load(R"(
version = 1
name = "north-1_b"
calibration = "calib/north.yaml"
[source]
kind = "v4l2"
rate_hz = 25
width_px = 640
height_px = 480
seed = 7
noise_sigma = 1.5
left = "left_%04d.png"
right = "/data/right_%04d.png"
first = 3
loop = false
left_device = "/dev/video0"
right_device = "/dev/video2"
pixel_format = "GREY"
controls = { exposure = 100, "gain, analogue" = -2 }
[virtual_rig]
azimuth_deg = -30
elevation_deg = 5.5
distance_m = 3
baseline_m = 0.2
field_of_view_deg = 60
doffs_px = 12
scene = 7
[match]
matcher = "gradient"
width_px = 200
preset = "fast"
disparities = 32
fill = false
[keep]
folder = "/var/takes"
gigabytes = 12.5
[stream]
bind = "tcp://0.0.0.0:5601"
jpeg_quality = 0
chroma = "4:2:2"
queue_frames = 2
road = "srt"
key_file = "keys/rig.key"
authorized_hosts = "/etc/hosts.keys"
)");
    EXPECT_EQ(config.name, "north-1_b");
    EXPECT_EQ(config.calibration, folder_.path() / "calib/north.yaml");
    EXPECT_EQ(config.source.kind, "v4l2");
    EXPECT_EQ(config.source.rate_hz, 25.0);
    EXPECT_EQ(config.source.width_px, 640);
    EXPECT_EQ(config.source.height_px, 480);
    EXPECT_EQ(config.source.seed, 7u);
    EXPECT_EQ(config.source.noise_sigma, 1.5);
    EXPECT_EQ(config.source.left, (folder_.path() / "left_%04d.png").string());
    EXPECT_EQ(config.source.right, "/data/right_%04d.png");
    EXPECT_EQ(config.source.first, 3);
    EXPECT_FALSE(config.source.loop);
    EXPECT_EQ(config.source.left_device, "/dev/video0");
    EXPECT_EQ(config.source.right_device, "/dev/video2");
    EXPECT_EQ(config.source.pixel_format, "GREY");
    EXPECT_EQ(config.source.controls,
              (std::map<std::string, int>{{"exposure", 100}, {"gain, analogue", -2}}));
    EXPECT_EQ(config.virtual_rig.azimuth_deg, -30.0);
    EXPECT_EQ(config.virtual_rig.elevation_deg, 5.5);
    EXPECT_EQ(config.virtual_rig.distance_m, 3.0);
    EXPECT_EQ(config.virtual_rig.baseline_m, 0.2);
    EXPECT_EQ(config.virtual_rig.field_of_view_deg, 60.0);
    EXPECT_EQ(config.virtual_rig.doffs_px, 12.0);
    EXPECT_EQ(config.virtual_rig.scene, 7);
    EXPECT_EQ(config.match.matcher, "gradient");
    EXPECT_EQ(config.match.preset, "fast");
    EXPECT_EQ(config.match.width_px, 200);
    EXPECT_EQ(config.match.disparities, 32);
    EXPECT_FALSE(config.match.fill);
    EXPECT_TRUE(config.match.steady);
    EXPECT_EQ(config.stream.bind, "tcp://0.0.0.0:5601");
    EXPECT_EQ(config.stream.jpeg_quality, 0);
    EXPECT_EQ(config.stream.chroma, "4:2:2");
    EXPECT_EQ(config.stream.queue_frames, 2);
    EXPECT_EQ(config.stream.road, "srt");
    EXPECT_EQ(config.keep.folder, "/var/takes");
    EXPECT_EQ(config.keep.gigabytes, 12.5);
    EXPECT_EQ(config.keep.hours, 24);
    EXPECT_EQ(config.stream.key_file, folder_.path() / "keys/rig.key");
    EXPECT_EQ(config.stream.authorized_hosts, "/etc/hosts.keys");
}

TEST_F(RigConfigTest, ReadsTheOldNameOfAKeyWithAWarning) {
    const std::string top = "version = 1\nname = 'a'\ncalibration = 'none'\n[virtual_rig]\n";
    testing::internal::CaptureStderr();
    EXPECT_EQ(load(top + "set = 3\n").virtual_rig.scene, 3);  // old name
    EXPECT_THAT(testing::internal::GetCapturedStderr(),
                testing::HasSubstr("config.toml:5: 'set' in [virtual_rig] is now called 'scene'"));
    EXPECT_EQ(fault(top + "set = -1\n"),
              "config.toml:5: 'scene' in [virtual_rig] is -1, but must be 0 to 1000000");
    EXPECT_EQ(fault(top + "scene = 3\nset = 3\n"),
              "config.toml:6: 'set' in [virtual_rig] is the old name of 'scene': keep one");
}

TEST_F(RigConfigTest, NamesTheLineAndTheNearestKeyOfAnUnknownKey) {
    EXPECT_EQ(fault("version = 1\nname = 'a'\n[match]\nfill = true\nmathcer = 'x'\n"),
              "config.toml:5: there is no key 'mathcer' in [match]; the nearest is 'matcher'");
    EXPECT_EQ(fault("version = 1\nname = 'a'\n[sauce]\n"),
              "config.toml:3: there is no key 'sauce'; the nearest is 'source'");
    EXPECT_EQ(fault("version = 1\nname = 'a'\n\nwheels = 4\n"),
              "config.toml:4: there is no key 'wheels'; the ones there are: version, name, "
              "calibration, source, virtual_rig, trigger, match, stream, keep");
}

TEST_F(RigConfigTest, ReportsAMistypedNameAndDoesNotReplaceIt) {
    EXPECT_EQ(fault("version = 1\nnaem = 'a'\n"),
              "config.toml:2: there is no key 'naem'; the nearest is 'name'");
}

/// Two rigs that run the installed file must not have the same name.
TEST_F(RigConfigTest, ARigWithoutANameHasThatOfItsComputer) {
    std::array<char, 256> host{};
    ASSERT_EQ(::gethostname(host.data(), host.size() - 1), 0);
    const std::string name(host.data());
    EXPECT_EQ(load("version = 1\n").name, name.substr(0, name.find('.')));
    EXPECT_EQ(load_rig_config(source_folder() / "hw_config/rig.toml").name,
              load("version = 1\n").name);
}

TEST_F(RigConfigTest, NamesTheWantedType) {
    const std::string head = "version = 1\nname = 'a'\n";
    EXPECT_EQ(fault(head + "[source]\nrate_hz = 'fast'\n"),
              "config.toml:4: 'rate_hz' in [source] must be a number, but is a string");
    EXPECT_EQ(fault(head + "[source]\nwidth_px = 320.5\n"),
              "config.toml:4: 'width_px' in [source] must be an integer, but is a number with a "
              "fraction");
    EXPECT_EQ(fault(head + "[source]\nloop = 1\n"),
              "config.toml:4: 'loop' in [source] must be true or false, but is an integer");
    EXPECT_EQ(fault(head + "match = 3\n"),
              "config.toml:3: 'match' must be a table, but is an integer");
    EXPECT_EQ(fault(head + "[source]\nkind = true\n"),
              "config.toml:4: 'kind' in [source] must be a string, but is true or false");
    EXPECT_EQ(fault(head + "[source]\nseed = -1\n"),
              "config.toml:4: 'seed' in [source] is -1, but must be at least 0");
    EXPECT_EQ(fault(head + "[source.controls]\ngain = 1.5\n"),
              "config.toml:4: 'gain' in [source.controls] must be an integer, but is a number with "
              "a fraction");
}

TEST_F(RigConfigTest, NamesTheLimit) {
    const std::string head = "version = 1\nname = 'a'\n";
    EXPECT_EQ(fault(head + "[match]\ndisparities = 257\n"),
              "config.toml:4: 'disparities' in [match] is 257, but must be 1 to 256");
    EXPECT_EQ(fault(head + "[match]\ndisparities = 99999999999\n"),
              "config.toml:4: 'disparities' in [match] is 99999999999, but must be 1 to 256");
    EXPECT_EQ(fault(head + "[source]\nfirst = -1\n"),
              "config.toml:4: 'first' in [source] is -1, but must be at least 0");
    EXPECT_EQ(fault(head + "[source]\nrate_hz = inf\n"),
              "config.toml:4: 'rate_hz' in [source] must be a finite number");
    EXPECT_EQ(fault(head + "[source]\nrate_hz = 0\n"),
              "config.toml:4: 'rate_hz' in [source] is 0, but must be 0.01 to 1000");
    EXPECT_EQ(fault(head + "[match]\npreset = 'qualty'\n"),
              "config.toml:4: 'preset' in [match] must not be 'qualty'; the nearest is 'quality'");
    EXPECT_EQ(
        fault(head + "[stream]\nbind = 'tcp://here'\n"),
        "config.toml:4: bind = \"tcp://here\" is not an endpoint of the form tcp://HOST:PORT");
    EXPECT_EQ(fault(head + "[source]\npixel_format = 'GREYS'\n"),
              "config.toml:4: 'pixel_format' in [source] must be a code of four characters such as "
              "'GREY' or 'MJPG'");
    EXPECT_EQ(
        fault(head + "calibration = ''\n"),
        "config.toml:3: 'calibration' must not be empty: leave the key out if there is no such "
        "file");
    EXPECT_EQ(fault("version = 1\nname = 'a b'\n"),
              "config.toml:2: 'name' is 'a b', but must be 1 to 64 letters, digits, '-' and '_'");
}

TEST_F(RigConfigTest, RequiresItsVersion) {
    EXPECT_EQ(fault("name = 'a'\n"),
              "config.toml: the key 'version' is missing; put `version = 1` at the top");
    EXPECT_EQ(fault("version = 2\nname = 'a'\n"),
              "config.toml:1: 'version' is 2, but this program reads version 1");
    EXPECT_EQ(fault("version = '1'\nname = 'a'\n"),
              "config.toml:1: 'version' must be an integer, but is a string");
}

TEST_F(RigConfigTest, NamesTheLineThatIsNotToml) {
    EXPECT_TRUE(fault("version = 1\nname = \n").starts_with("config.toml:2: this is not TOML: "));
    EXPECT_TRUE(fault("version = 1\nname = 'a'\nname = 'b'\n")
                    .starts_with("config.toml:3: this is not TOML: "));
    EXPECT_NE(fault(std::string("version = 1\nname = '\xff\xfe'\n")), "");
}

TEST_F(RigConfigTest, RefusesAMissingFileAndAFolder) {
    EXPECT_NE(thrown_sentence([&] { load_rig_config(folder_.path() / "none.toml"); }), "");
    EXPECT_NE(thrown_sentence([&] { load_rig_config(folder_.path()); }), "");
    EXPECT_NE(fault("#" + std::string(2 << 20, 'x')), "");
}

TEST_F(RigConfigTest, RequiresALineForATriggerThatUsesOne) {
    const std::string top = "version = 1\nname = 'a'\n[trigger]\n";
    EXPECT_EQ(load(top + "role = 'lead'\nchip = 'c'\nline = 'GPIO17'\n").trigger.line, "GPIO17");
    EXPECT_EQ(load(top + "role = 'follow'\nchip = 'c'\nline_offset = 4\n").trigger.line_offset, 4);
    EXPECT_TRUE(load(top + "role = 'lead'\npretended = true\n").trigger.pretended);
    EXPECT_THAT(fault(top + "role = 'lead'\n"), testing::HasSubstr("needs 'chip'"));
    EXPECT_THAT(fault(top + "role = 'follow'\nchip = 'c'\n"), testing::HasSubstr("'line_offset'"));
    EXPECT_THAT(fault(top + "role = 'follow'\npretended = true\n"),
                testing::HasSubstr("needs the role 'lead'"));
    EXPECT_THAT(fault(top + "line = 'a'\nline_offset = 4\n"), testing::HasSubstr("keep one"));
    EXPECT_THAT(fault(top + "role = 'led'\n"), testing::HasSubstr("lead"));
}

TEST_F(RigConfigTest, OneSideIsNoRigUnlessBothAreInItsPictures) {
    const auto refusal = [&](const std::string& source) {
        return thrown_sentence(
            [&] { load("version = 1\nname = \"a\"\n[source]\nkind = \"files\"\n" + source); });
    };
    EXPECT_NE(refusal("left = \"a.mp4\"\n").find("side_by_side = true"), std::string::npos);
    EXPECT_EQ(refusal("left = \"a.mp4\"\nside_by_side = true\n"), "");
    EXPECT_EQ(refusal("left = \"a.mp4\"\nright = \"b.mp4\"\n"), "");
    EXPECT_NE(refusal("left = \"a.mp4\"\nright = \"b.mp4\"\nside_by_side = true\n"), "");
}

TEST_F(RigConfigTest, OneCameraIsNoRigUnlessItDeliversBothSides) {
    for (const std::string kind : {"v4l2", "libcamera"}) {
        const auto refusal = [&](const std::string& source) {
            return thrown_sentence([&] {
                load("version = 1\nname = \"a\"\n[source]\nkind = \"" + kind + "\"\n" + source);
            });
        };
        EXPECT_THAT(refusal("left_device = \"/dev/video0\"\n"),
                    testing::HasSubstr("say side_by_side = true"));
        EXPECT_EQ(refusal("left_device = \"/dev/video0\"\nside_by_side = true\n"), "");
        EXPECT_EQ(refusal("left_device = \"a\"\nright_device = \"b\"\n"), "");
        EXPECT_THAT(refusal("left_device = \"a\"\nright_device = \"b\"\nside_by_side = true\n"),
                    testing::HasSubstr("leave 'right_device' out"));
    }
}

}  // namespace
}  // namespace vantage

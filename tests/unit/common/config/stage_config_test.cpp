#include "common/config/stage_config.h"

#include <gtest/gtest.h>

#include "tests/unit/common/config/config_text.h"

namespace vantage {
namespace {

using StageConfigTest = ConfigText<load_stage_config>;

TEST_F(StageConfigTest, ReadsEveryKey) {
    const StageConfig config = load(R"(
version = 1
key_file = "host.key"
rate_hz = 25.0
latency_budget_ms = 120
[[rigs]]
name = "north"
endpoint = "tcp://10.0.0.1:5600"
public_key = "rq:rM>}U?@Lns47E1%kR.o@n%FcmmsL/@{H8]yf7"
[[rigs]]
name = "south"
endpoint = "tcp://10.0.0.2:5600"
[view]
width_px = 640
height_px = 360
field_of_view_deg = 40
target_m = [0, 1.5, -0.5]
distance_m = 3
azimuth_deg = 20
elevation_deg = 15
synthesiser = "mesh"
)");
    ASSERT_EQ(config.rigs.size(), 2u);
    EXPECT_EQ(config.rigs[0].name, "north");
    EXPECT_EQ(config.rigs[0].endpoint, "tcp://10.0.0.1:5600");
    EXPECT_EQ(config.rigs[0].public_key, "rq:rM>}U?@Lns47E1%kR.o@n%FcmmsL/@{H8]yf7");
    EXPECT_EQ(config.rigs[1].name, "south");
    EXPECT_EQ(config.key_file, folder_.path() / "host.key");
    EXPECT_EQ(config.rate_hz, 25.0);
    EXPECT_EQ(config.latency_budget_ms, 120.0);
    EXPECT_EQ(config.view.width_px, 640);
    EXPECT_EQ(config.view.height_px, 360);
    EXPECT_EQ(config.view.field_of_view_deg, 40.0);
    EXPECT_EQ(config.view.target_m[1], 1.5);
    EXPECT_EQ(config.view.target_m[2], -0.5);
    EXPECT_EQ(config.view.distance_m, 3.0);
    EXPECT_EQ(config.view.azimuth_deg, 20.0);
    EXPECT_EQ(config.view.elevation_deg, 15.0);
    EXPECT_EQ(config.view.synthesiser, "mesh");
}

TEST_F(StageConfigTest, ReadsARigsPublicKeyFromAFile) {
    const std::string key = "rq:rM>}U?@Lns47E1%kR.o@n%FcmmsL/@{H8]yf7";
    const std::string rig =
        "version = 1\n[[rigs]]\nname = 'a'\nendpoint = 'tcp://h:1'\npublic_key_file = 'a.pub'\n";
    std::ofstream(folder_.path() / "a.pub") << key << "\n";
    EXPECT_EQ(load(rig).rigs[0].public_key, key);
    EXPECT_EQ(
        fault(rig + "public_key = '" + key + "'\n"),
        "config.toml:5: 'public_key_file' in [[rigs]] and 'public_key' exclude each other: keep "
        "one");
    std::ofstream(folder_.path() / "a.pub") << "\n";
    EXPECT_EQ(fault(rig), "config.toml:5: 'public_key_file' in [[rigs]] is empty: " +
                              (folder_.path() / "a.pub").string());
    std::filesystem::remove(folder_.path() / "a.pub");
    EXPECT_NE(fault(rig).find("a.pub"), std::string::npos);
}

TEST_F(StageConfigTest, RequiresRigsWithUniqueNames) {
    const std::string rig = "[[rigs]]\nname = 'a'\nendpoint = 'tcp://h:1'\n";
    EXPECT_EQ(fault("version = 1\n"), "config.toml:1: 'rigs' is missing");
    EXPECT_EQ(fault("version = 1\nrigs = []\n"),
              "config.toml:2: 'rigs' is empty: a stage needs at least one rig");
    EXPECT_EQ(
        fault("version = 1\n" + rig + rig),
        "config.toml:6: 'name' in [[rigs]] is 'a' a second time: every rig needs its own name");
    EXPECT_EQ(fault("version = 1\n[[rigs]]\nname = 'a'\n"),
              "config.toml:2: 'endpoint' in [[rigs]] is missing");
}

TEST_F(StageConfigTest, AcceptsOnlyKnownTimeZones) {
    const std::string head =
        "version = 1\n[[rigs]]\nname = 'a'\nendpoint = 'tcp://h:1'\n[timecode]\n";
    EXPECT_EQ(load(head + "zone = 'Europe/Stockholm'\n").timecode_zone, "Europe/Stockholm");
    EXPECT_EQ(fault(head + "zone = 'Europe/Stokholm'\n"),
              "config.toml:6: 'zone' in [timecode] = 'Europe/Stokholm' is not a time zone of "
              "this computer; timedatectl list-timezones lists them");
}

TEST_F(StageConfigTest, NamesLineAndMendOfAFault) {
    const std::string head = "version = 1\n[[rigs]]\nname = 'a'\nendpoint = 'tcp://h:1'\n";
    EXPECT_EQ(
        fault(head + "publickey = ''\n"),
        "config.toml:5: there is no key 'publickey' in [[rigs]]; the nearest is 'public_key'");
    EXPECT_EQ(fault("version = 1\n[[rigs]]\nname = 'a'\nendpoint = 'tcp://h:70000'\n"),
              "config.toml:4: endpoint = \"tcp://h:70000\" is not an endpoint of the form "
              "tcp://HOST:PORT");
    EXPECT_EQ(fault(head + "[view]\ntarget_m = [1, 2]\n"),
              "config.toml:6: 'target_m' in [view] must be an array of 3 numbers, but has 2");
    EXPECT_EQ(fault(head + "[view]\ntarget_m = [1, 2, 'x']\n"),
              "config.toml:6: 'target_m' in [view] must be an array of 3 numbers, but is a string");
    EXPECT_EQ(
        fault(head + "[view]\ntarget_m = 1\n"),
        "config.toml:6: 'target_m' in [view] must be an array of 3 numbers, but is an integer");
    EXPECT_EQ(fault("version = 1\nrigs = [1]\n"),
              "config.toml:2: 'rigs' must be an array of tables, [[rigs]], but is an integer");
    EXPECT_EQ(fault("version = 1\nrigs = 'a'\n"),
              "config.toml:2: 'rigs' must be an array of tables, [[rigs]], but is a string");
}

}  // namespace
}  // namespace vantage

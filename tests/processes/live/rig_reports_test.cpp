#include <fstream>
#include <memory>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/base/cli/version.h"
#include "common/wire/curve_keys.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/free_ports.h"

namespace vantage {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A stage with a running rig, a missing rig, and secrets in every file that may have them.
class RigReports : public testing::Test {
  protected:
    RigReports() {
        for (const auto& [name, keys] : {std::pair("rig.key", rig_keys_), {"host.key", host_keys_}})
            write_key_file(file(name), keys);
        std::ofstream(file("hosts.keys")) << host_keys_.public_key << " gallery\n";
        std::ofstream(file("live.env"))
            << "VANTAGE_LIVE_OPTIONS=--output srt://house:9000?passphrase=" << phrase_ << '\n';
        std::ofstream(file("stage.toml"))
            << "version = 1\nrate_hz = 5\nkey_file = \"host.key\"\n# password: " << phrase_
            << "\n[[rigs]]\nname = \"north\"\nendpoint = \"" << endpoint(ports_.first)
            << "\"\npublic_key = \"" << rig_keys_.public_key
            << "\"\n[[rigs]]\nname = \"south\"\nendpoint = \"" << endpoint(ports_.second)
            << "\"\npublic_key = \"" << rig_keys_.public_key << "\"\n";
        std::ofstream(file("north.toml"))
            << "version = 1\nname = \"north\"\n# token = " << phrase_
            << "\n[source]\nrate_hz = 5\nwidth_px = 64\nheight_px = 48\n[stream]\nbind = \""
            << endpoint(ports_.first)
            << "\"\nkey_file = \"rig.key\"\nauthorized_hosts = \"hosts.keys\"\n";
        rig_ = std::make_unique<ChildProgram>(
            VANTAGE_RIG_PROGRAM, std::vector<std::string>{"run", "--config", file("north.toml")},
            folder_.path());
        rig_->wait_for("publishing on");
    }

    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
    static std::string endpoint(int port) { return fmt::format("tcp://127.0.0.1:{}", port); }
    ProgramResult rigs(std::vector<std::string> arguments, const std::string& wait_s) const {
        arguments.insert(arguments.begin(), "rigs");
        arguments.insert(arguments.end(), {"--stage", file("stage.toml"), "--wait", wait_s});
        return run_to_end(VANTAGE_PROGRAM, arguments);
    }
    std::string text_of(const std::string& name) const {
        std::stringstream text;
        text << std::ifstream(file("vantage-report/" + name)).rdbuf();
        return text.str();
    }

    TemporaryFolder folder_;
    const std::pair<int, int> ports_ = two_free_ports();
    const CurveKeys rig_keys_ = generate_curve_keys(), host_keys_ = generate_curve_keys();
    const std::string phrase_ = "correct-Horse1";
    std::unique_ptr<ChildProgram> rig_;
};

TEST_F(RigReports, ContainTheFilesWithoutSecrets) {
    const ProgramResult result = rigs({"bugreport", "-o", file("report.tar.gz"), "--json"}, "30");
    ASSERT_EQ(result.status, 0) << result.err << rig_->err();
    EXPECT_EQ(nlohmann::json::parse(result.out).at("answered"), 1);
    ASSERT_EQ(
        run_to_end("/usr/bin/tar", {"-xzf", file("report.tar.gz"), "-C", folder_.path().string()})
            .status,
        0);
    int files = 0;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(file("vantage-report"))) {
        if (!entry.is_regular_file()) continue;
        ++files;
        const std::string name =
            std::filesystem::relative(entry.path(), file("vantage-report")).string();
        const std::string text = text_of(name);
        for (const std::string& secret : {rig_keys_.secret_key, rig_keys_.public_key,
                                          host_keys_.secret_key, host_keys_.public_key, phrase_})
            EXPECT_EQ(text.find(secret), std::string::npos) << secret << " in " << name;
    }
    EXPECT_GE(files, 6);
    EXPECT_THAT(text_of("stage.toml"), HasSubstr("rate_hz = 5"));
    EXPECT_THAT(text_of("live.env"), HasSubstr("srt://house:9000?passphrase=[left out]"));
    EXPECT_THAT(text_of("rigs/south.txt"), HasSubstr("connection refused"));
    const auto north = nlohmann::json::parse(text_of("rigs/north.json"));
    EXPECT_EQ(north.at("version"), std::string(version()));
    EXPECT_THAT(north.at("config").get<std::string>(), HasSubstr("width_px = 64"));
    EXPECT_TRUE(north.at("probe").contains("gpu")) << north.at("probe");
    EXPECT_THAT(north.at("log").dump(), HasSubstr("is attached"));
    EXPECT_THAT(north.at("addresses").dump(), HasSubstr("127.0.0.1"));
    EXPECT_TRUE(north.at("clock_steps").is_array());
    EXPECT_TRUE(north.at("refused_inputs").is_array());
    const auto status = nlohmann::json::parse(text_of("status.json"));
    EXPECT_EQ(status.at("rigs")[0].at("health").at("version"), std::string(version()));
    EXPECT_THAT(status.at("addresses").dump(), HasSubstr("127.0.0.1"));
    EXPECT_NE(status.at("keyboard").get<std::string>(), "");
}

TEST_F(RigReports, ListTheVersionsOfTheRigs) {
    const ProgramResult result = rigs({"update", "--json"}, "2");
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("1 of 2 rigs did not answer"));
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("rigs")[0].at("version"), std::string(version()));
    EXPECT_EQ(json.at("rigs")[0].at("same"), true);
    EXPECT_EQ(json.at("rigs")[1].at("same"), false);
}

}  // namespace
}  // namespace vantage

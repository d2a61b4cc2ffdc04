#include <chrono>
#include <csignal>
#include <fstream>
#include <memory>
#include <regex>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/source_folder.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* ip = "/usr/sbin/ip";

std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

void run_ip(const std::vector<std::string>& arguments) {
    const ProgramResult result = run_to_end(ip, arguments);
    if (result.status != 0) fail("ip: {}", result.err);
}

/// The network of a stage: two namespaces, each with an eth0, and a wire between them. Both have
/// one clock, the kernel's: an offset that PTP finds is the error of its stamps.
class StageNetwork {
  public:
    StageNetwork() {
        for (const char* computer : {"host", "rig"}) run_ip({"netns", "add", computer});
        run_ip({"link", "add", "eth0", "netns", "rig", "type", "veth", "peer", "name", "eth0",
                "netns", "host"});
        for (const auto& [computer, address] :
             {std::pair("host", "10.7.0.1/24"), std::pair("rig", "10.7.0.2/24")}) {
            run_ip({"-n", computer, "address", "add", address, "dev", "eth0"});
            for (const char* device : {"lo", "eth0"})
                run_ip({"-n", computer, "link", "set", device, "up"});
        }
    }
    ~StageNetwork() {
        for (const char* computer : {"host", "rig"}) run_to_end(ip, {"netns", "delete", computer});
    }
    StageNetwork(const StageNetwork&) = delete;
    StageNetwork& operator=(const StageNetwork&) = delete;

    /// The words that run a program on one of the computers.
    static std::vector<std::string> on(const std::string& computer,
                                       const std::vector<std::string>& words) {
        std::vector<std::string> all = {"netns", "exec", computer};
        all.insert(all.end(), words.begin(), words.end());
        return all;
    }
};

class Ptp : public testing::Test {
  protected:
    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

    std::unique_ptr<ChildProgram> start(const std::string& computer,
                                        const std::vector<std::string>& words) const {
        return std::make_unique<ChildProgram>(ip, StageNetwork::on(computer, words),
                                              folder_.path());
    }
    static ProgramResult run_on(const std::string& computer,
                                const std::vector<std::string>& words) {
        return run_to_end(ip, StageNetwork::on(computer, words));
    }

    std::unique_ptr<ChildProgram> start_grandmaster() const {
        std::ofstream(file("host.conf"))
            << std::regex_replace(text_of(source_folder() / "hw_config/ptp/host.conf"),
                                  std::regex("(time_stamping +)hardware"), "$1software");
        // Both computers have one /var/run here, and ptp4l's usual socket is the rig's.
        return start("host", {"/usr/sbin/ptp4l", "-m", "-f", file("host.conf"), "--uds_address",
                              file("ptp4l-host")});
    }

    /// A clock that is emulated on a busy computer jumps by milliseconds: ptp4l is to put up with
    /// that, and not to take half a minute to look at the clock's drift first.
    std::unique_ptr<ChildProgram> start_follower() const {
        return start("rig", {"/usr/sbin/ptp4l", "-m", "-f",
                             (source_folder() / "hw_config/ptp/rig-software.conf").string(),
                             "--step_threshold", "0", "--sanity_freq_limit", "0",
                             "--pi_integral_const", "0.01"});
    }

    /// Keys as a technician makes them, a rig on the network and the stage that names it.
    void configure() const {
        const auto public_half = [&](const char* program, const std::string& name) {
            const ProgramResult result = run_to_end(program, {"keys", "new", file(name), "--json"});
            return nlohmann::json::parse(result.out).at("public_key").get<std::string>();
        };
        const std::string rig_key = public_half(VANTAGE_RIG_PROGRAM, "rig.key");
        std::ofstream(file("hosts.keys")) << public_half(VANTAGE_PROGRAM, "host.key") << '\n';
        std::ofstream(file("rig.toml"))
            << "version = 1\nname = \"rig\"\n[source]\nrate_hz = 0.2\nwidth_px = 80\n"
            << "height_px = 60\n[match]\nmatcher = \"exact\"\ndisparities = 32\n[stream]\n"
            << "bind = \"tcp://10.7.0.2:5600\"\nkey_file = \"rig.key\"\n"
            << "authorized_hosts = \"hosts.keys\"\n";
        std::ofstream(file("stage.toml"))
            << "version = 1\nkey_file = \"host.key\"\nrate_hz = 0.2\nlatency_budget_ms = 60000\n"
            << "[view]\nwidth_px = 64\nheight_px = 36\nsynthesiser = \"mesh\"\n[[rigs]]\n"
            << "name = \"rig\"\nendpoint = \"tcp://10.7.0.2:5600\"\npublic_key = \"" << rig_key
            << "\"\n";
    }

    /// What `vantage rigs status` says of the rig's clock.
    nlohmann::json status() const {
        const ProgramResult result = run_on("host", {VANTAGE_PROGRAM, "rigs", "status", "--stage",
                                                     file("stage.toml"), "--wait", "60", "--json"});
        return nlohmann::json::parse(result.out).at("rigs").at(0);
    }
    /// Looks at it until the host says so; what it said last.
    nlohmann::json status_when_clock_begins(const std::string& text) const {
        nlohmann::json seen;
        for (int look = 0; look < 100; ++look) {
            seen = status();
            if (seen["clock"].get<std::string>().rfind(text, 0) == 0) break;
            std::this_thread::sleep_for(1s);
        }
        return seen;
    }

    TemporaryFolder folder_;
    StageNetwork network_;
};

TEST_F(Ptp, HostShowsWhatARealPtp4lSaysOfTheRigAndThatItIsGone) {
    configure();
    const auto grandmaster = start_grandmaster();
    const auto follower = start_follower();
    const auto rig = start("rig", {VANTAGE_RIG_PROGRAM, "run", "--config", file("rig.toml")});
    const nlohmann::json settled = status_when_clock_begins("PTP SLAVE");
    ASSERT_EQ(settled["sync"]["ptp_state"], "SLAVE")
        << settled << '\n'
        << rig->err() << follower->out() << grandmaster->out();
    EXPECT_EQ(settled["sync"]["disciplined"], true) << settled;

    // So say the programs that come with it.
    const ProgramResult pmc = run_on(
        "rig", {"/usr/sbin/pmc", "-u", "-b", "0", "-i", file("pmc"), "GET CURRENT_DATA_SET"});
    EXPECT_THAT(pmc.out, HasSubstr("stepsRemoved     1"));
    std::printf("hil: ptp %s\n%s\n", settled["sync"].dump().c_str(), pmc.out.c_str());
    const ProgramResult live =
        run_on("host", {VANTAGE_PROGRAM, "live", "--stage", file("stage.toml"), "--headless",
                        "--frames", "1", "--wait", "300", "--json"});
    ASSERT_EQ(live.status, 0) << live.err;
    const nlohmann::json shown = nlohmann::json::parse(live.out).at("rigs").at(0);
    std::printf("hil: live %s; %s\n", shown["clock"].dump().c_str(), shown["sync"].dump().c_str());
    EXPECT_THAT(shown["clock"].get<std::string>(), StartsWith("PTP SLAVE, offset "));
    // One clock with itself: what is left is how unevenly emulation stamps messages.
    for (const nlohmann::json& sync : {settled["sync"], shown["sync"]}) {
        EXPECT_NE(sync["ptp_offset_ns"], 0);
        EXPECT_LT(std::abs(sync["ptp_offset_ns"].get<double>()), 10e6);
        EXPECT_GT(sync["ptp_path_delay_ns"], 0);
        EXPECT_LT(sync["ptp_path_delay_ns"], 10e6);
    }

    // Its master is gone, then it is gone itself.
    grandmaster->send_signal(SIGKILL);
    EXPECT_THAT(
        status_when_clock_begins("clocks not disciplined")["clock"].get<std::string>(),
        AllOf(StartsWith("clocks not disciplined: skew unknown"), HasSubstr("ptp4l is LISTENING")));
    follower->send_signal(SIGKILL);
    EXPECT_EQ(status_when_clock_begins("clocks not disciplined: skew unknown (no")["clock"],
              "clocks not disciplined: skew unknown (no ptp4l at the rig)");
}

}  // namespace
}  // namespace vantage

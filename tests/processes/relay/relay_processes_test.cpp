#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "common/config/stage_config.h"
#include "common/receive/stage_receiver.h"
#include "common/take/take_reader.h"
#include "common/wire/curve_keys.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"
#include "tests/support/free_ports.h"

namespace vantage {
namespace {

/// A rig, a relay and two hosts: all but one of the hosts are processes of their own, and all have
/// keys.
class RelayProcesses : public testing::Test {
  protected:
    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
    std::string key_of(const std::string& name) const {
        const CurveKeys keys = generate_curve_keys();
        write_key_file(file(name + ".key"), keys);
        return keys.public_key;
    }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(file(name)) << text;
    }
    std::unique_ptr<ChildProgram> start(const char* program, std::vector<std::string> arguments,
                                        const std::string& folder) const {
        std::filesystem::create_directory(folder_.path() / folder);
        return std::make_unique<ChildProgram>(program, arguments, folder_.path() / folder);
    }

    TemporaryFolder folder_;
    std::pair<int, int> ports_ = two_free_ports();
};

TEST_F(RelayProcesses, TwoHostsRecordOneRigWhoseFramesCrossItsUplinkOnce) {
    const std::string rig_key = key_of("rig"), relay_key = key_of("relay");
    write("rig.hosts", relay_key + " the relay\n");
    write("relay.hosts", key_of("first") + " a host\n" + key_of("second") + " a host\n");
    write("rig.toml", fmt::format("version = 1\nname = \"north\"\n"
                                  "[source]\nrate_hz = 5\nwidth_px = 96\nheight_px = 72\n"
                                  "[match]\nmatcher = \"exact\"\ndisparities = 32\n"
                                  "[keep]\nfolder = \"{}\"\n"
                                  "[stream]\nbind = \"tcp://127.0.0.1:{}\"\n"
                                  "key_file = \"rig.key\"\nauthorized_hosts = \"rig.hosts\"\n",
                                  file("kept"), ports_.first));
    write("relay.toml", fmt::format("version = 1\nkey_file = \"relay.key\"\nrate_hz = 5\n"
                                    "[[rigs]]\nname = \"north\"\nendpoint = "
                                    "\"tcp://127.0.0.1:{}\"\npublic_key = \"{}\"\n",
                                    ports_.first, rig_key));
    const auto rig = start(VANTAGE_RIG_PROGRAM, {"run", "--config", file("rig.toml")}, "rig");
    const auto relay =
        start(VANTAGE_PROGRAM,
              {"relay", "--stage", file("relay.toml"), "--listen",
               fmt::format("tcp://127.0.0.1:{}", ports_.second), "--authorized-hosts",
               file("relay.hosts"), "--rigs-file", file("rigs.toml"), "--json"},
              "relay");
    ASSERT_TRUE(eventually([&] { return std::filesystem::exists(file("rigs.toml")); }))
        << relay->err();
    std::ifstream entries(file("rigs.toml"));
    const std::string rigs{std::istreambuf_iterator<char>(entries), {}};
    for (const char* host : {"first", "second"})
        write(fmt::format("{}.toml", host),
              fmt::format("version = 1\nkey_file = \"{}.key\"\nrate_hz = 5\nlatency_budget_ms = "
                          "5000\n[view]\nwidth_px = 96\nheight_px = 64\n{}",
                          host, rigs));

    std::mutex mutex;
    std::map<std::uint64_t, std::shared_ptr<const PackedFrame>> came;
    auto second = std::make_unique<StageReceiver>(
        load_stage_config(file("second.toml")), StageReceiver::Purpose::film,
        [&](const ArrivedFrame& frame) {
            const std::uint64_t pulse = decode_frame_head(frame.packed->header).frame.trigger_index;
            const std::lock_guard lock(mutex);
            came[pulse] = frame.packed;
        });
    const ProgramResult live = run_to_end(
        VANTAGE_PROGRAM, {"live", "--stage", file("first.toml"), "--headless", "--json", "--wait",
                          "60", "--synth", "mesh", "--frames", "15", "--take", file("take.mkv")});
    ASSERT_EQ(live.status, 0) << live.err;
    second.reset();
    relay->send_signal(SIGTERM);
    const ProgramResult relayed = relay->wait();
    ASSERT_EQ(relayed.status, 0) << relayed.err;
    rig->send_signal(SIGTERM);
    const ProgramResult filmed = rig->wait();

    // What the rig kept on its own disk is what it sent.
    std::map<std::uint64_t, StoredFrame> kept;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / "kept")) {
        if (entry.path().extension() != ".mkv") continue;  // the ledger of what is kept
        const TakeReader take(entry.path());
        for (const TakeReader::Frame& frame : take.frames(0))
            kept[frame.pulse] = take.load(0, frame);
    }
    const TakeReader take(file("take.mkv"));
    EXPECT_GE(take.frames(0).size(), 10u);
    for (const TakeReader::Frame& frame : take.frames(0)) {
        ASSERT_TRUE(kept.contains(frame.pulse));
        const StoredFrame stored = take.load(0, frame);
        EXPECT_EQ(stored.colour, kept[frame.pulse].colour);
        EXPECT_EQ(stored.depth, kept[frame.pulse].depth);
        EXPECT_EQ(stored.record.header, kept[frame.pulse].record.header);
    }
    EXPECT_GE(came.size(), 10u);
    for (const auto& [pulse, frame] : came) {
        ASSERT_TRUE(kept.contains(pulse));
        EXPECT_EQ(frame->header, kept[pulse].record.header);
        EXPECT_EQ(frame->colour, kept[pulse].colour);
    }

    const nlohmann::json stats = nlohmann::json::parse(relayed.out)["rigs"][0];
    EXPECT_EQ(stats["name"], "north");
    EXPECT_EQ(stats["hosts"].size(), 2u);
    EXPECT_EQ(stats["undecodable"], 0);
    EXPECT_LE(stats["frames"].get<std::size_t>(), kept.size()) << "each came once";
    for (const nlohmann::json& host : stats["hosts"])
        EXPECT_LE(host["sent"], stats["frames"]) << "and went to each host once";
    const std::string attached = "host " + relay_key + " is attached";
    EXPECT_THAT(filmed.err, testing::HasSubstr(attached));
    for (const char* host : {"first", "second"})
        EXPECT_THAT(filmed.err, testing::Not(testing::HasSubstr(
                                    load_key_file(file(fmt::format("{}.key", host))).public_key)))
            << "the rig serves the relay alone";
}

TEST_F(RelayProcesses, SaysInASentenceWhatKeepsItFromListening) {
    write("stage.toml",
          "version = 1\n[[rigs]]\nname = \"a\"\nendpoint = \"tcp://127.0.0.1:5600\"\n");
    const ProgramResult result = run_to_end(
        VANTAGE_PROGRAM, {"relay", "--stage", file("stage.toml"), "--listen", "tcp://*:5700"});
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, testing::HasSubstr("--authorized-hosts"));
}

}  // namespace
}  // namespace vantage

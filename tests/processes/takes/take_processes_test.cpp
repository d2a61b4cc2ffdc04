#include <array>
#include <csignal>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "common/base/error.h"
#include "common/config/stage_config.h"
#include "common/receive/stage_receiver.h"
#include "common/take/take_check.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"
#include "tests/support/free_ports.h"

namespace vantage {
namespace {

/// Two tiny rigs on the virtual stage, each a process of its own, and what listens to them.
class TakeProcesses : public testing::Test {
  protected:
    TakeProcesses() {
        std::ofstream(file("stage.toml"))
            << "version = 1\nrate_hz = 5\nlatency_budget_ms = 5000\n[view]\nwidth_px = 96\n"
               "height_px = 64\n"
            << stage_entry("left", ports_.first) << stage_entry("right", ports_.second);
        start_rig("left", ports_.first, -12);
        start_rig("right", ports_.second, 12);
    }
    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
    static std::string endpoint(int port) { return fmt::format("tcp://127.0.0.1:{}", port); }
    static std::string stage_entry(const std::string& rig, int port) {
        return "[[rigs]]\nname = \"" + rig + "\"\nendpoint = \"" + endpoint(port) + "\"\n";
    }
    void start_rig(const std::string& name, int port, double azimuth_deg) {
        std::ofstream(file(name + ".toml"))
            << "version = 1\nname = \"" << name
            << "\"\n[source]\nrate_hz = 5\nwidth_px = 96\nheight_px = 72\n"
            << "[virtual_rig]\nazimuth_deg = " << azimuth_deg
            << "\n[match]\nmatcher = \"exact\"\ndisparities = 32\n"
            << "[keep]\nfolder = \"" << file("kept") << "\"\n"
            << "[stream]\nbind = \"" << endpoint(port) << "\"\n";
        rigs_.push_back(std::make_unique<ChildProgram>(
            VANTAGE_RIG_PROGRAM, std::vector<std::string>{"run", "--config", file(name + ".toml")},
            folder_.path()));
    }
    std::vector<std::string> live(const std::vector<std::string>& options) const {
        std::vector<std::string> all{"live",       "--stage", file("stage.toml"),
                                     "--headless", "--json",  "--wait",
                                     "60",         "--synth", "mesh"};
        all.insert(all.end(), options.begin(), options.end());
        return all;
    }
    static nlohmann::json run(const std::vector<std::string>& arguments) {
        const ProgramResult result = run_to_end(VANTAGE_PROGRAM, arguments);
        EXPECT_EQ(result.status, 0) << result.err;
        return nlohmann::json::parse(result.out, nullptr, false);
    }

    TemporaryFolder folder_;
    std::pair<int, int> ports_ = two_free_ports();
    std::vector<std::unique_ptr<ChildProgram>> rigs_;
};

TEST_F(TakeProcesses, ATakeHoldsWhatTheRigsSentByteForByteAndPlays) {
    // Another host of the same rigs, which notes all that comes.
    std::mutex mutex;
    std::map<std::pair<std::size_t, std::uint64_t>, std::shared_ptr<const PackedFrame>> sent;
    const StageReceiver tap(load_stage_config(file("stage.toml")), StageReceiver::Purpose::film,
                            [&](const ArrivedFrame& frame) {
                                const std::uint64_t pulse =
                                    decode_frame_head(frame.packed->header).frame.trigger_index;
                                const std::lock_guard lock(mutex);
                                sent[{frame.rig, pulse}] = frame.packed;
                            });
    const nlohmann::json summary = run(live({"--frames", "15", "--take", file("take.mkv")}));
    EXPECT_EQ(summary["take"]["state"], "ended");
    EXPECT_EQ(summary["take"]["failure"], "");
    EXPECT_GE(summary["take"]["frames"], 10);

    const TakeReader take(file("take.mkv"));
    EXPECT_EQ(check_take(take).damage.size(), 0u);
    EXPECT_EQ(summary["take"]["frames"], take.frames(0).size() + take.frames(1).size());
    EXPECT_GE(take.cameras().size(), 5u);
    std::size_t compared = 0;
    for (std::size_t rig = 0; rig < 2; ++rig)
        for (const TakeReader::Frame& frame : take.frames(rig)) {
            const std::lock_guard lock(mutex);
            const auto found = sent.find({rig, frame.pulse});
            if (found == sent.end()) continue;
            const StoredFrame stored = take.load(rig, frame);
            EXPECT_EQ(stored.colour, found->second->colour);
            EXPECT_EQ(stored.record.header, found->second->header);
            ++compared;
        }
    EXPECT_GE(compared, 10u);

    const nlohmann::json played =
        run({"play", file("take.mkv"), "--headless", "--json", "--synth", "mesh"});
    const std::uint64_t last = std::max(take.frames(0).back().pulse, take.frames(1).back().pulse);
    EXPECT_EQ(played["time"]["shown_pulse"], last) << "played to the end";
    EXPECT_GE(played["new_pictures"], 2);
    // The newest pulse by then: a busy computer's rigs may miss one.
    const auto shown_at = [&](std::uint64_t pulse) {
        std::uint64_t newest = 0;
        for (const std::size_t rig : {0, 1})
            for (const TakeReader::Frame& frame : take.frames(rig))
                if (frame.pulse <= pulse) newest = std::max(newest, frame.pulse);
        return newest;
    };
    const std::uint64_t first =
        std::min(take.frames(0).front().pulse, take.frames(1).front().pulse);
    for (const auto& [from, pulses] : {std::pair("0", 0u), {"1.4", 7u}, {"0.6", 3u}})
        EXPECT_EQ(run({"play", file("take.mkv"), "--headless", "--json", "--synth", "mesh",
                       "--speed", "0", "--frames", "1", "--from", from})["time"]["shown_pulse"],
                  shown_at(first + pulses));
}

TEST_F(TakeProcesses, ATakeOfAKilledHostOpensAndLacksASecondAtMost) {
    ChildProgram host(VANTAGE_PROGRAM, live({"--take", file("take.mkv")}), folder_.path());
    const auto frames = [&]() -> std::size_t {
        try {
            return TakeReader(file("take.mkv")).frames(0).size();
        } catch (const Error&) {
            return 0;
        }
    };
    ASSERT_TRUE(eventually([&] { return frames() >= 10; })) << host.err();
    host.send_signal(SIGKILL);
    host.wait();
    const TakeReader take(file("take.mkv"));
    EXPECT_FALSE(take.is_ended());
    const TakeVerdict verdict = check_take(take);
    // A busy computer's rigs may miss pulses; the host leaves nothing out.
    for (const std::size_t rig : {0, 1}) EXPECT_EQ(take.frames(rig).back().dropped, 0u);
    EXPECT_GE(verdict.frames, 10u);
    // It may have been killed in the middle of a write.
    EXPECT_LE(verdict.damage.size(), 2u);
    for (const TakeDamage& damage : verdict.damage)
        EXPECT_NE(damage.words.find("are truncated"), std::string::npos) << damage.words;
}

TEST_F(TakeProcesses, TakesOfTwoHostsTogetherLackNoFrameWhileOneAfterTheOtherIsReplaced) {
    // An observer, which notes every pulse of each rig.
    std::mutex mutex;
    std::array<std::set<std::uint64_t>, 2> sent;
    const StageReceiver tap(
        load_stage_config(file("stage.toml")), StageReceiver::Purpose::film,
        [&](const ArrivedFrame& frame) {
            const std::lock_guard lock(mutex);
            sent[frame.rig].insert(decode_frame_head(frame.packed->header).frame.trigger_index);
        });
    const auto start = [&](const std::string& take) {
        return std::make_unique<ChildProgram>(VANTAGE_PROGRAM, live({"--take", file(take)}),
                                              folder_.path());
    };
    const auto pulses_of = [&](const std::string& take, std::size_t rig) {
        std::set<std::uint64_t> pulses;
        try {
            const TakeReader reader(file(take));
            for (const TakeReader::Frame& frame : reader.frames(rig)) pulses.insert(frame.pulse);
        } catch (const Error&) {
        }
        return pulses;
    };
    const auto has_more = [&](const std::string& take) {
        const std::size_t before = pulses_of(take, 1).size();
        return eventually([&] { return pulses_of(take, 1).size() >= before + 5; });
    };
    const auto first = start("first.mkv"), second = start("second.mkv");
    ASSERT_TRUE(has_more("first.mkv") && has_more("second.mkv")) << second->err();
    first->send_signal(SIGKILL);
    first->wait();
    ASSERT_TRUE(has_more("second.mkv")) << second->err();
    const auto third = start("third.mkv");
    ASSERT_TRUE(has_more("third.mkv")) << third->err();
    second->send_signal(SIGINT);
    second->wait();
    ASSERT_TRUE(has_more("third.mkv")) << third->err();
    third->send_signal(SIGINT);
    third->wait();

    for (const std::size_t rig : {0, 1}) {
        std::set<std::uint64_t> taken;
        for (const char* take : {"first.mkv", "second.mkv", "third.mkv"})
            taken.merge(pulses_of(take, rig));
        ASSERT_GE(taken.size(), 20u);
        const std::lock_guard lock(mutex);
        std::size_t compared = 0;
        for (const std::uint64_t pulse : sent.at(rig)) {
            if (pulse < *taken.begin() || pulse > *taken.rbegin()) continue;
            EXPECT_EQ(taken.count(pulse), 1u) << "pulse " << pulse << " of rig " << rig;
            ++compared;
        }
        EXPECT_GE(compared, 20u);
    }
}

TEST_F(TakeProcesses, ARigKeepsATakeOfItsOwnWhichClosesTheGapsOfTheHosts) {
    run(live({"--frames", "5", "--take", file("one.mkv")}));
    run(live({"--frames", "5", "--take", file("two.mkv")}));
    for (const auto& rig : rigs_) {
        rig->send_signal(SIGTERM);
        EXPECT_EQ(rig->wait().status, 0) << rig->err();
    }
    std::vector<std::string> join{"take", "join", file("one.mkv"), file("two.mkv")};
    for (const auto& entry : std::filesystem::directory_iterator(file("kept")))
        if (entry.path().extension() == ".mkv") join.push_back(entry.path());
    ASSERT_EQ(join.size(), 2u + 2 + 2) << "a file a rig";
    join.insert(join.end(), {"-o", file("all.mkv"), "--json"});
    const nlohmann::json joined = run(join);
    const TakeReader one(file("one.mkv")), two(file("two.mkv")), all(file("all.mkv"));
    EXPECT_EQ(joined["twice"], one.frames(0).size() + one.frames(1).size() + two.frames(0).size() +
                                   two.frames(1).size())
        << "what the hosts have the rigs have too";
    EXPECT_TRUE(check_take(all).damage.empty());
    // Between the hosts' takes was nobody but the rigs, which on a busy computer miss a pulse.
    const auto pulses_of = [](const std::vector<TakeReader::Frame>& frames) {
        std::vector<std::uint64_t> pulses;
        for (const TakeReader::Frame& frame : frames) pulses.push_back(frame.pulse);
        return pulses;
    };
    const auto rig_of = [](const TakeReader& kept) -> std::size_t {
        return kept.facts().rigs[0].name == "left" ? 0 : 1;
    };
    for (const std::size_t i : {4, 5}) {
        const TakeReader kept(join[i]);
        EXPECT_EQ(pulses_of(all.frames(rig_of(kept))), pulses_of(kept.frames(0)));
    }
    // And the same bytes.
    const TakeReader kept(join[4]);
    const std::size_t rig = rig_of(kept);
    std::size_t compared = 0;
    for (const TakeReader::Frame& frame : kept.frames(0))
        for (const TakeReader::Frame& hosts : two.frames(rig))
            if (hosts.pulse == frame.pulse) {
                EXPECT_EQ(two.load(rig, hosts).colour, kept.load(0, frame).colour);
                EXPECT_EQ(two.load(rig, hosts).depth, kept.load(0, frame).depth);
                EXPECT_EQ(two.load(rig, hosts).record.header, kept.load(0, frame).record.header);
                ++compared;
            }
    EXPECT_GE(compared, 3u);
}

TEST_F(TakeProcesses, GapsOfTheHostsTakeAreFetchedFromTheRigs) {
    run(live({"--frames", "5", "--take", file("one.mkv")}));
    sleep(1);  // five pulses, however fast the next host is there
    run(live({"--frames", "5", "--take", file("two.mkv")}));
    run({"take", "join", file("one.mkv"), file("two.mkv"), "-o", file("gaps.mkv"), "--json"});
    ASSERT_FALSE(check_take(TakeReader(file("gaps.mkv"))).is_whole())
        << "between the hosts' takes was nobody";
    // Beside a host that films; the rigs go on.
    ChildProgram host(VANTAGE_PROGRAM, live({"--frames", "1000"}), folder_.path());
    const std::vector<std::string> fetch{
        "rigs",           "fetch", "--stage",       file("stage.toml"), "--gaps-of",
        file("gaps.mkv"), "-o",    file("fetched"), "--wait",           "60",
        "--json"};
    const nlohmann::json fetched = run(fetch);
    std::vector<std::string> join{"take", "join", file("gaps.mkv")};
    for (const auto& rig : fetched["rigs"]) {
        EXPECT_GE(rig["frames"], 1) << rig;
        for (const auto& path : rig["files"]) join.push_back(path);
    }
    join.insert(join.end(), {"-o", file("whole.mkv"), "--json"});
    EXPECT_EQ(run(join)["twice"], 0) << "only what was lacking came";
    for (const auto& rig : run(fetch)["rigs"]) EXPECT_EQ(rig["frames"], 0) << "all is here";
    host.send_signal(SIGTERM);
    for (const auto& rig : rigs_) {
        rig->send_signal(SIGTERM);
        EXPECT_EQ(rig->wait().status, 0) << rig->err();
    }
    // Against what the rigs kept, byte for byte: nothing lacks that they have.
    const TakeReader whole(file("whole.mkv"));
    std::size_t compared = 0;
    for (const auto& entry : std::filesystem::directory_iterator(file("kept"))) {
        if (entry.path().extension() != ".mkv") continue;  // the ledger of what is kept
        const TakeReader kept(entry.path());
        const std::size_t rig = kept.facts().rigs[0].name == "left" ? 0 : 1;
        const auto& there = whole.frames(rig);
        for (const TakeReader::Frame& frame : kept.frames(0)) {
            if (frame.pulse < there.front().pulse || frame.pulse > there.back().pulse) continue;
            const auto found = std::find_if(
                there.begin(), there.end(),
                [&](const TakeReader::Frame& each) { return each.pulse == frame.pulse; });
            ASSERT_NE(found, there.end()) << "pulse " << frame.pulse;
            const StoredFrame a = whole.load(rig, *found), b = kept.load(0, frame);
            EXPECT_EQ(a.colour, b.colour);
            EXPECT_EQ(a.depth, b.depth);
            EXPECT_EQ(a.record.header, b.record.header);
            ++compared;
        }
    }
    EXPECT_GE(compared, 10u);
}

TEST_F(TakeProcesses, ATakeThatCannotBeBegunIsToldBeforeAnythingIsFlown) {
    std::ofstream(file("take.mkv")) << "somebody's";
    const ProgramResult result =
        run_to_end(VANTAGE_PROGRAM, live({"--frames", "2", "--take", file("take.mkv")}));
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find("never replaces a file"), std::string::npos) << result.err;
    EXPECT_EQ(result.out, "");
}

}  // namespace
}  // namespace vantage

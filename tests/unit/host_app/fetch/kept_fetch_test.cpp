#include <atomic>
#include <fstream>
#include <map>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/time/pulse_grid.h"
#include "common/take/kept_files.h"
#include "common/take/take_check.h"
#include "common/take/take_edit.h"
#include "host_app/takes/rig_fetch.h"
#include "rig_firmware/keep/kept_reader.h"
#include "rig_firmware/stream/publisher.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/common/take/small_take.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr double rate_hz = 25;
constexpr auto patience = 60s;

/// Two rigs with files of what they filmed during the last minute.
class KeptFetchTest : public testing::Test {
  protected:
    KeptFetchTest() {
        for (const char* rig : {"north", "south"}) {
            std::filesystem::create_directories(kept(rig));
            write_small_take(kept(rig) / kept_file_name(rig, begin_s_), {rig}, first_, first_ + 19);
            write_small_take(kept(rig) / kept_file_name(rig, begin_s_ + 1), {rig}, first_ + 20,
                             first_ + 39);
        }
    }

    std::filesystem::path kept(const std::string& rig) const { return folder_.path() / rig; }
    std::filesystem::path fetched() const {
        std::filesystem::create_directories(folder_.path() / "fetched");
        return folder_.path() / "fetched";
    }
    static RigConfig::Stream open_stream() {
        RigConfig::Stream stream;
        stream.bind = "tcp://127.0.0.1:*";
        return stream;
    }
    std::unique_ptr<Publisher> start(const std::string& rig,
                                     const RigConfig::Stream& stream = open_stream()) const {
        auto publisher = std::make_unique<Publisher>(stream, rig);
        publisher->serve_kept(
            [reader = std::make_shared<KeptReader>(kept(rig), rig, rate_hz)](
                std::uint64_t from, std::uint64_t to) { return reader->first_of(from, to); });
        return publisher;
    }
    static StageConfig stage_of(const std::vector<const Publisher*>& rigs,
                                const std::vector<std::string>& names) {
        StageConfig stage;
        stage.rate_hz = rate_hz;
        for (std::size_t i = 0; i < rigs.size(); ++i)
            stage.rigs.push_back({names[i], rigs[i]->endpoint(), rigs[i]->public_key()});
        return stage;
    }
    KeptFetch all() const {
        KeptFetch fetch;
        fetch.range = [this](int) { return PulseRange{first_, first_ + 40}; };
        fetch.folder = fetched();
        fetch.bytes_s = 1e9;
        fetch.patience = patience;
        return fetch;
    }
    static std::vector<FetchStats> run(const KeptFetch& fetch, const StageConfig& stage) {
        const MonotonicTime end = MonotonicClock::now() + patience;
        return fetch.run(
            stage, [&] { return MonotonicClock::now() > end; }, [](const auto&) {});
    }
    /// Every frame of the rig in a folder, by pulse.
    static std::map<std::uint64_t, StoredFrame> frames_in(const std::filesystem::path& folder,
                                                          const std::string& rig) {
        std::map<std::uint64_t, StoredFrame> frames;
        for (const KeptFile& file : kept_files(folder, rig)) {
            const TakeReader take(file.path);
            EXPECT_TRUE(take.damage().empty());
            for (const TakeReader::Frame& frame : take.frames(0))
                EXPECT_TRUE(frames.emplace(frame.pulse, take.load(0, frame)).second)
                    << "pulse " << frame.pulse << " is there twice";
        }
        return frames;
    }
    void expect_as_kept(const std::string& rig) const {
        const auto here = frames_in(fetched(), rig), there = frames_in(kept(rig), rig);
        ASSERT_EQ(here.size(), there.size());
        for (const auto& [pulse, frame] : there) {
            const StoredFrame& other = here.at(pulse);
            EXPECT_EQ(other.colour, frame.colour);
            EXPECT_EQ(other.depth, frame.depth);
            EXPECT_EQ(other.record.header, frame.record.header);
            EXPECT_EQ(other.record.session, frame.record.session);
            EXPECT_EQ(other.record.arrival, frame.record.arrival);
        }
    }

    TemporaryFolder folder_;
    const std::time_t begin_s_ = std::time(nullptr) - 60;
    const std::uint64_t first_ =
        PulseGrid(rate_hz).index_at_or_before(TaiClock::now() - std::chrono::seconds(60));
};

TEST_F(KeptFetchTest, FetchesRecordingsByteForByte) {
    const auto north = start("north"), south = start("south");
    const StageConfig stage = stage_of({north.get(), south.get()}, {"north", "south"});
    const std::vector<FetchStats> stats = run(all(), stage);
    ASSERT_EQ(stats.size(), 2u);
    for (const FetchStats& rig : stats) {
        EXPECT_TRUE(rig.is_done);
        EXPECT_EQ(rig.trouble, "");
        EXPECT_EQ(rig.frames, 40u);
        EXPECT_EQ(rig.not_kept, 0u);
        ASSERT_EQ(rig.files.size(), 1u);
        EXPECT_TRUE(check_take(TakeReader(rig.files[0])).is_whole());
        expect_as_kept(rig.rig);
    }
    EXPECT_EQ(north->status().hosts.at(0).fetched, 40u);

    const std::vector<FetchStats> again = run(all(), stage);
    EXPECT_EQ(again[0].frames, 0u) << "all is here";
    EXPECT_EQ(again[0].there, 40u);
    expect_as_kept("north");
}

TEST_F(KeptFetchTest, ResumesAnInterruptedFetchWithoutReplacingFiles) {
    const auto north = start("north");
    const StageConfig stage = stage_of({north.get()}, {"north"});
    KeptFetch part = all();
    part.range = [this](int) { return PulseRange{first_, first_ + 13}; };
    const auto before = run(part, stage);
    const std::vector<std::byte> bytes = bytes_of_file(before[0].files[0]);
    const auto after = run(all(), stage);
    EXPECT_EQ(after[0].wanted, 27u);
    EXPECT_EQ(after[0].frames, 27u);
    EXPECT_EQ(bytes_of_file(before[0].files[0]), bytes);
    expect_as_kept("north");
}

TEST_F(KeptFetchTest, FetchesOnlyFramesThatATakeLacks) {
    const auto north = start("north");
    const auto path = folder_.path() / "hosts.mkv";
    std::vector<std::uint64_t> gaps{first_ + 3, first_ + 4, first_ + 17, first_ + 21, first_ + 38};
    write_small_take(path, {"north"}, first_, first_ + 39, gaps);
    KeptFetch fetch = all();
    fetch.take = std::make_shared<const TakeReader>(path);
    const auto stats = run(fetch, stage_of({north.get()}, {"north"}));
    EXPECT_EQ(stats[0].frames, gaps.size());
    std::vector<std::uint64_t> brought;
    for (const auto& [pulse, frame] : frames_in(fetched(), "north")) brought.push_back(pulse);
    EXPECT_EQ(brought, gaps);
    const TakeReader closing(stats[0].files.at(0));
    copy_takes({fetch.take.get(), &closing}, 0, ~std::uint64_t{0}, folder_.path() / "whole.mkv");
    EXPECT_TRUE(check_take(TakeReader(folder_.path() / "whole.mkv")).is_whole());
}

TEST_F(KeptFetchTest, ContinuesAfterARestartOfTheRig) {
    auto north = start("north");
    const StageConfig stage = stage_of({north.get()}, {"north"});
    RigConfig::Stream stream = open_stream();
    stream.bind = north->endpoint();
    KeptFetch fetch = all();
    fetch.bytes_s = 60e3;  // some frames per second
    std::thread again([&] {
        EXPECT_TRUE(eventually([&] {
            return !north->status().hosts.empty() && north->status().hosts[0].fetched >= 10;
        }));
        north.reset();
        north = start("north", stream);
    });
    const auto stats = run(fetch, stage);
    again.join();
    EXPECT_TRUE(stats[0].is_done);
    EXPECT_EQ(stats[0].trouble, "");
    EXPECT_EQ(stats[0].frames, 40u);
    EXPECT_GT(north->status().hosts.at(0).fetched, 0u) << "some came after";
    expect_as_kept("north");
}

TEST_F(KeptFetchTest, CountsPulsesThatTheRigHasNotRecorded) {
    const auto north = start("north");
    KeptFetch fetch = all();
    fetch.range = [this](int) { return PulseRange{first_ - 5, first_ + 60}; };
    const auto stats = run(fetch, stage_of({north.get()}, {"north"}));
    EXPECT_EQ(stats[0].frames, 40u);
    EXPECT_EQ(stats[0].not_kept, 25u);
    EXPECT_EQ(stats[0].trouble, "");
}

TEST_F(KeptFetchTest, ReportsARigWithoutRecordings) {
    const Publisher north(open_stream(), "north");
    const auto stats = run(all(), stage_of({&north}, {"north"}));
    EXPECT_THAT(stats[0].trouble, HasSubstr("[keep]"));
    EXPECT_EQ(north.status().refused_fetches, 1u);
}

TEST_F(KeptFetchTest, RefusesAHostThatTheRigDoesNotKnow) {
    RigConfig::Stream stream = open_stream();
    stream.key_file = folder_.path() / "rig.key";
    stream.authorized_hosts = folder_.path() / "authorized_hosts";
    write_key_file(stream.key_file, generate_curve_keys());
    const CurveKeys known = generate_curve_keys(), unknown = generate_curve_keys();
    std::ofstream(stream.authorized_hosts) << known.public_key << "\n";
    const auto north = start("north", stream);
    StageConfig stage = stage_of({north.get()}, {"north"});
    stage.key_file = folder_.path() / "unknown.key";
    write_key_file(stage.key_file, unknown);
    KeptFetch fetch = all();
    fetch.patience = 1s;
    const auto refused = run(fetch, stage);
    EXPECT_THAT(refused[0].trouble, HasSubstr("authorized_hosts"));
    EXPECT_EQ(refused[0].frames, 0u);
    EXPECT_TRUE(north->status().hosts.empty());

    stage.key_file = folder_.path() / "known.key";
    write_key_file(stage.key_file, known);
    const auto served = run(all(), stage);
    EXPECT_EQ(served[0].trouble, "");
    expect_as_kept("north");
}

TEST_F(KeptFetchTest, ReportsARateDifferentFromTheStages) {
    const auto north = start("north");
    StageConfig stage = stage_of({north.get()}, {"north"});
    stage.rate_hz = 30;
    EXPECT_THAT(run(all(), stage)[0].trouble, HasSubstr("25 pulses per second"));
}

TEST_F(KeptFetchTest, RefusesARigOutsideTheStage) {
    KeptFetch fetch = all();
    fetch.rigs = {"west"};
    EXPECT_THAT(thrown_sentence([&] { (void)run(fetch, {}); }), HasSubstr("west"));
}

/// What the reader finds, by pulse.
TEST_F(KeptFetchTest, TheReaderSkipsDamageAndFollowsAGrowingFile) {
    const std::filesystem::path damaged = kept("north") / kept_file_name("north", begin_s_);
    const TakeReader before(damaged);
    std::vector<std::byte> bytes = bytes_of_file(damaged);
    bytes[before.frames(0)[5].colour.at + 10] ^= std::byte{1};
    std::filesystem::remove(damaged);
    write_bytes(damaged, bytes);
    KeptReader reader(kept("north"), "north", rate_hz);
    EXPECT_EQ(reader.first_of(first_ + 4, first_ + 40)->pulse, first_ + 4);
    EXPECT_EQ(reader.first_of(first_ + 5, first_ + 40)->pulse, first_ + 6);
    EXPECT_EQ(reader.first_of(first_ + 5, first_ + 6), nullptr);

    const auto path = kept("north") / kept_file_name("north", begin_s_ + 2);
    TakeWriter writer(path, small_facts({"north"}, first_ + 40));
    FrameStorer storer(writer.facts().rigs[0]);
    EXPECT_EQ(reader.first_of(first_ + 40, first_ + 99), nullptr);
    for (std::uint64_t pulse = first_ + 40; pulse < first_ + 80; ++pulse)
        writer.add(0, storer.store(sent_frame("north", pulse)));
    ASSERT_TRUE(eventually([&] { return reader.first_of(first_ + 40, first_ + 99) != nullptr; }));
    EXPECT_EQ(reader.first_of(first_ + 40, first_ + 99)->pulse, first_ + 40);
}

}  // namespace
}  // namespace vantage

#include "common/take/take_recorder.h"

#include <future>

#include <gtest/gtest.h>

#include "common/base/files/output_path.h"
#include "common/base/time/pulse_grid.h"
#include "common/base/time/time.h"
#include "common/take/take_reader.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/common/take/small_take.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

class TakeRecorderTest : public testing::Test {
  protected:
    static TakeRecorder::Settings settings() {
        TakeRecorder::Settings settings;
        settings.rigs = {"north", "south"};
        settings.pulse_rate_hz = 25;
        settings.program = "a test";
        settings.show = {{"key", "value"}};
        settings.disk_mb_s = [](const auto&) { return 1000.0; };
        return settings;
    }
    static ArrivedFrame arrived(std::size_t rig, std::uint64_t pulse, MonotonicTime at = {}) {
        ArrivedFrame frame;
        frame.rig = rig;
        frame.packed =
            std::make_shared<const PackedFrame>(sent_frame(rig == 0 ? "north" : "south", pulse));
        frame.link.sent = pulse;
        frame.arrival = at;
        return frame;
    }
    /// The disk answers once it is released.
    static TakeRecorder::Settings with_a_disk_held_by(std::promise<void>& release) {
        TakeRecorder::Settings wanted = settings();
        wanted.disk_mb_s = [gate = release.get_future().share()](const auto&) {
            gate.wait();
            return 1000.0;
        };
        return wanted;
    }
    static void offer_both(TakeRecorder& recorder, std::uint64_t first, std::uint64_t last) {
        for (std::uint64_t pulse = first; pulse <= last; ++pulse)
            for (const std::size_t rig : {0, 1}) recorder.offer(arrived(rig, pulse));
    }
    std::uint64_t frames_of(std::size_t rig) const { return TakeReader(take_).frames(rig).size(); }

    TemporaryFolder folder_;
    std::filesystem::path take_ = folder_.path() / "take.mkv";
};

TEST_F(TakeRecorderTest, WritesFramesOfferedDuringTheTake) {
    TakeRecorder recorder(settings());
    offer_both(recorder, 1000, 1004);
    recorder.begin(take_);
    EXPECT_TRUE(recorder.is_running());
    offer_both(recorder, 1005, 1030);
    CameraRecord camera;
    camera.tick = 3;
    camera.time = PulseGrid(25).time_of(1010);
    recorder.offer(camera);
    recorder.finish();
    EXPECT_FALSE(recorder.is_running());
    offer_both(recorder, 1031, 1032);

    const TakeReader reader(take_);
    EXPECT_TRUE(reader.is_ended());
    EXPECT_TRUE(reader.damage().empty());
    for (const std::size_t rig : {0, 1}) {
        ASSERT_EQ(reader.frames(rig).size(), 26u);
        EXPECT_EQ(reader.frames(rig).front().pulse, 1005u);
        EXPECT_EQ(reader.frames(rig).back().pulse, 1030u);
        EXPECT_EQ(reader.frames(rig).back().link.sent, 1030u);
        EXPECT_EQ(reader.load(rig, reader.frames(rig)[3]).colour,
                  arrived(rig, 1008).packed->colour);
    }
    EXPECT_EQ(reader.facts().show["key"], "value");
    const TakeState state = recorder.state();
    EXPECT_EQ(state.phase, TakePhase::none);
    EXPECT_EQ(state.frames, 52u);
    EXPECT_EQ(state.rigs[1].frames, 26u);
    EXPECT_EQ(state.rigs[1].dropped + state.rigs[1].refused, 0u);
    EXPECT_EQ(state.bytes, std::filesystem::file_size(take_));
}

TEST_F(TakeRecorderTest, IncludesThePreRoll) {
    TakeRecorder::Settings wanted = settings();
    wanted.pre_roll = 2s;
    TakeRecorder recorder(wanted);
    const MonotonicTime start = MonotonicTime(100s);
    for (std::uint64_t pulse = 1000; pulse <= 1100; ++pulse) {
        const MonotonicTime now = start + (pulse - 1000) * 40ms;
        for (const std::size_t rig : {0, 1}) recorder.offer(arrived(rig, pulse, now));
        CameraRecord camera;
        camera.tick = pulse;
        camera.time = PulseGrid(25).time_of(pulse);
        recorder.offer(camera, now);
    }
    EXPECT_NEAR(recorder.pre_roll().seconds, 2, 0.05);
    EXPECT_GT(recorder.pre_roll().bytes, 0u);
    recorder.begin(take_);
    recorder.offer(arrived(0, 1101));
    recorder.finish();
    const TakeReader reader(take_);
    EXPECT_EQ(reader.frames(0).front().pulse, 1050u);
    EXPECT_EQ(reader.frames(0).size(), 52u) << "neither a frame twice nor one missing";
    EXPECT_EQ(reader.frames(0).back().pulse, 1101u);
    ASSERT_EQ(reader.cameras().size(), 51u) << "the programme's flight begins with it";
    EXPECT_EQ(reader.cameras().front().tick, 1050u);
    EXPECT_EQ(recorder.state().gaps, 0u);
}

TEST_F(TakeRecorderTest, CountsAndRecordsDroppedFrames) {
    TakeRecorder::Settings wanted = settings();
    std::promise<void> looked_at, release;
    wanted.queue_bytes = 40'000;
    // The disk is looked at for so long that the queue overflows after the first frames.
    wanted.disk_mb_s = [&looked_at, gate = release.get_future().share()](const auto&) {
        looked_at.set_value();
        gate.wait();
        return 1000.0;
    };
    TakeRecorder recorder(wanted);
    recorder.begin(take_);
    offer_both(recorder, 1000, 1000);
    looked_at.get_future().wait();
    offer_both(recorder, 1001, 1060);
    release.set_value();
    recorder.finish();
    const TakeState state = recorder.state();
    const TakeReader reader(take_);
    for (const std::size_t rig : {0, 1}) {
        EXPECT_GT(state.rigs[rig].dropped, 0u);
        EXPECT_EQ(state.rigs[rig].dropped + state.rigs[rig].frames, 61u);
        EXPECT_EQ(reader.frames(rig).size(), state.rigs[rig].frames);
        EXPECT_EQ(reader.frames(rig).back().pulse, 1060u) << "the oldest went";
        EXPECT_EQ(reader.frames(rig).back().dropped, state.rigs[rig].dropped);
    }
    EXPECT_GT(state.gaps, 0u);
}

TEST_F(TakeRecorderTest, ReportedFramesAreInTheUnfinishedFile) {
    TakeRecorder recorder(settings());
    recorder.begin(take_);
    for (std::uint64_t pulse = 1000; pulse < 1010; ++pulse) {
        offer_both(recorder, pulse, pulse);
        const std::uint64_t offered = 2 * (pulse - 999);
        ASSERT_TRUE(eventually([&] { return recorder.state().frames >= offered; }));
        EXPECT_EQ(frames_of(0) + frames_of(1), offered) << "as if it were killed now";
    }
}

TEST_F(TakeRecorderTest, ReportsTheLongestUnwrittenTime) {
    std::promise<void> release;
    TakeRecorder recorder(with_a_disk_held_by(release));
    recorder.begin(take_);
    const MonotonicTime begun = MonotonicClock::now();
    offer_both(recorder, 1000, 1099);
    while (MonotonicClock::now() - begun < 50ms) std::this_thread::sleep_for(1ms);
    const double held_ms = ms_since(begun);
    release.set_value();
    ASSERT_TRUE(eventually([&] { return recorder.state().frames >= 200; }));
    const TakeReader take(take_);
    ASSERT_EQ(take.frames(0).size(), 100u);
    ASSERT_EQ(take.frames(1).size(), 100u);
    EXPECT_TRUE(take.damage().empty());
    for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(take.frames(1)[i].pulse, 1000 + i);
    EXPECT_GE(recorder.state().longest_unwritten_ms, 0.5 * held_ms);
}

TEST_F(TakeRecorderTest, RefusesASlowDiskAndNamesTheRates) {
    TakeRecorder::Settings wanted = settings();
    wanted.disk_mb_s = [](const auto&) { return 0.1; };
    TakeRecorder recorder(wanted);
    recorder.begin(take_);
    offer_both(recorder, 1000, 1001);
    recorder.finish();
    const TakeState state = recorder.state();
    EXPECT_EQ(state.phase, TakePhase::failed);
    EXPECT_NE(state.failure.find("writes 0.1 MB/s, and these rigs' frames need"), std::string::npos)
        << state.failure;
    EXPECT_FALSE(std::filesystem::exists(take_));
}

TEST_F(TakeRecorderTest, LimitsTheWaitForRigsAndAddsThemLater) {
    TakeRecorder::Settings wanted = settings();
    wanted.rig_wait = 20ms;
    TakeRecorder recorder(wanted);
    recorder.begin(take_);
    recorder.offer(arrived(0, 1000));
    ASSERT_TRUE(eventually([&] { return recorder.state().phase == TakePhase::recording; }));
    recorder.offer(arrived(1, 1003));
    recorder.finish();
    EXPECT_EQ(frames_of(0), 1u);
    EXPECT_EQ(frames_of(1), 1u);
}

TEST_F(TakeRecorderTest, RefusesInvalidPaths) {
    TakeRecorder recorder(settings());
    write_small_take(take_, {"north"}, 1, 2);
    EXPECT_NE(thrown_sentence([&] { recorder.begin(take_); }).find("never replaces a file"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([&] {
                  recorder.begin(folder_.path() / "take.mp4");
              }).find("has to end in .mkv"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([&] {
                  recorder.begin(folder_.path() / "no" / "take.mkv");
              }).find("cannot write"),
              std::string::npos);
    EXPECT_FALSE(recorder.is_running());
}

TEST_F(TakeRecorderTest, RecordsSeveralTakesInSequence) {
    TakeRecorder recorder(settings());
    for (const int take : {1, 2}) {
        recorder.begin(free_path(take_));
        offer_both(recorder, 1000, 1000 + static_cast<std::uint64_t>(take));
        recorder.finish();
    }
    EXPECT_EQ(frames_of(0), 2u);
    EXPECT_EQ(TakeReader(folder_.path() / "take-2.mkv").frames(0).size(), 3u);
    EXPECT_EQ(recorder.state().takes, 2u);
}

TEST_F(TakeRecorderTest, FollowsAChangedStageWithTheNextTake) {
    TakeRecorder recorder(settings());
    recorder.begin(take_);
    offer_both(recorder, 100, 103);
    // North leaves, and west joins with the next number.
    recorder.change_stage({{"north", "south", "west"}, {2, 1}, {{"key", "other"}}, {}});
    offer_both(recorder, 104, 105);
    ArrivedFrame west = arrived(1, 105);
    west.rig = 2;
    west.packed = std::make_shared<const PackedFrame>(sent_frame("west", 105));
    recorder.offer(west);
    recorder.finish();
    EXPECT_EQ(frames_of(0), 6u) << "the take keeps the rigs that it began with";
    EXPECT_EQ(frames_of(1), 6u);
    ASSERT_EQ(recorder.state().rigs.size(), 3u);
    EXPECT_EQ(recorder.state().rigs[2].name, "west");
    EXPECT_EQ(recorder.state().rigs[2].refused, 1u) << "and counts the others' frames";

    take_ = folder_.path() / "next.mkv";
    recorder.begin(take_);
    for (std::uint64_t pulse = 110; pulse <= 112; ++pulse) {
        recorder.offer(arrived(1, pulse));
        west.packed = std::make_shared<const PackedFrame>(sent_frame("west", pulse));
        recorder.offer(west);
    }
    recorder.finish();
    const TakeReader take(take_);
    ASSERT_EQ(take.facts().rigs.size(), 2u);
    EXPECT_EQ(take.facts().rigs[0].name, "west");
    EXPECT_EQ(take.facts().rigs[1].name, "south");
    EXPECT_EQ(take.facts().show.at("key"), "other");
    EXPECT_EQ(frames_of(0), 3u);
    EXPECT_EQ(frames_of(1), 3u);
    EXPECT_EQ(recorder.state().rigs.size(), 2u);
}

TEST_F(TakeRecorderTest, RefusesANewTakeWhileTheLastIsBeingWritten) {
    std::promise<void> release;
    TakeRecorder recorder(with_a_disk_held_by(release));
    recorder.begin(take_);
    offer_both(recorder, 1000, 1001);
    recorder.end();
    const std::string sentence =
        thrown_sentence([&] { recorder.begin(folder_.path() / "next.mkv"); });
    EXPECT_NE(sentence.find(take_.string() + " is still being written"), std::string::npos)
        << sentence;
    release.set_value();
    recorder.finish();
    EXPECT_EQ(frames_of(0), 2u);
    recorder.begin(folder_.path() / "next.mkv");
    EXPECT_TRUE(recorder.is_running());
}

TEST_F(TakeRecorderTest, ReportsATakeWithoutFrames) {
    TakeRecorder recorder(settings());
    recorder.begin(take_);
    recorder.finish();
    EXPECT_EQ(recorder.state().phase, TakePhase::failed);
    EXPECT_NE(recorder.state().failure.find("no frame came"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(take_));
}

TEST(DiskBenchmark, MeasuresAFolderAndLeavesNothingInIt) {
    const TemporaryFolder folder;
    EXPECT_GT(measure_disk_mb_s(folder.path()), 0);
    EXPECT_GT(free_disk_mb(folder.path()), 0);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    EXPECT_NE(
        thrown_sentence([&] { measure_disk_mb_s(folder.path() / "no"); }).find("cannot write"),
        std::string::npos);
}

}  // namespace
}  // namespace vantage

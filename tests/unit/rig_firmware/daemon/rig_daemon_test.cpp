#include "rig_firmware/daemon/rig_daemon.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"
#include "common/image/image_file.h"
#include "common/receive/stage_receiver.h"
#include "tests/support/data_folder.h"
#include "tests/support/gpu_reset.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

RigConfig small_rig() {
    RigConfig config;
    config.name = "test";
    config.source.width_px = 61;
    config.source.height_px = 47;
    config.source.rate_hz = 200;  // more than any processor renders
    config.match.disparities = 16;
    config.stream.bind = "tcp://127.0.0.1:*";
    return config;
}

std::set<int> threads() {
    std::set<int> ids;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task"))
        ids.insert(std::stoi(task.path().filename()));
    return ids;
}

/// Holds one thread of this process, by its name, as a driver that never answers would. Threads
/// that libraries start have the name of the one that called them: it is the first of that name
/// that was not there `before`.
class HeldThread {
  public:
    HeldThread(const std::string& name, const std::set<int>& before) {
        struct sigaction action {};
        action.sa_handler = [](int) {
            const int error = errno;
            char byte = 0;
            while (::read(pipe[0], &byte, 1) < 0 && errno == EINTR) {
            }
            errno = error;
        };
        action.sa_flags = SA_RESTART;
        ::sigaction(SIGUSR1, &action, nullptr);
        if (pipe[0] < 0 && ::pipe2(pipe.data(), O_CLOEXEC) != 0) std::abort();
        // A thread gives itself its name once it runs.
        int id = find(name, before);
        for (; id == 0; id = find(name, before)) std::this_thread::sleep_for(1ms);
        ::syscall(SYS_tgkill, ::getpid(), id, SIGUSR1);
    }
    ~HeldThread() { EXPECT_EQ(::write(pipe[1], "", 1), 1); }
    HeldThread(const HeldThread&) = delete;
    HeldThread& operator=(const HeldThread&) = delete;

  private:
    static int find(const std::string& name, const std::set<int>& before) {
        for (const int id : threads()) {
            std::string comm;
            std::ifstream("/proc/self/task/" + std::to_string(id) + "/comm") >> comm;
            if (comm == name && !before.contains(id)) return id;
        }
        return 0;
    }
    /// Kept for good: a held thread may come to read after the end of this object.
    static inline std::array<int, 2> pipe = {-1, -1};
};

class StuckThread : public testing::TestWithParam<const char*> {};

/// A stage of this rig alone, at the port that it was given.
StageConfig stage_of(const RigDaemon& daemon, const RigConfig& config) {
    const std::string line = daemon.report().back();
    const std::size_t begin = line.find("tcp://");
    StageConfig stage;
    stage.rate_hz = config.source.rate_hz;
    stage.rigs.push_back({"test", line.substr(begin, line.find(',') - begin), {}});
    return stage;
}

TEST(RigDaemon, AccountsForEveryFrameAtItsStop) {
    RigDaemon daemon(small_rig(), 5);
    while (daemon.running()) std::this_thread::sleep_for(5ms);
    daemon.stop();
    daemon.rethrow_failure();
    const DaemonStatus status = daemon.status();
    const RigCounters& counters = status.publisher.counters;
    EXPECT_EQ(counters.published, 5u);
    EXPECT_EQ(counters.captured, counters.published + counters.late);
    EXPECT_EQ(status.latency_ms.count, 5u);
    EXPECT_GT(status.latency_ms.p50, status.match_ms.p50);
}

TEST(RigDaemon, SaysItsRateFromItsFirstWordOn) {
    const RigConfig config = small_rig();
    const RigDaemon daemon(config);
    const StageReceiver onlooker(stage_of(daemon, config), StageReceiver::Purpose::observe);
    for (int i = 0; i < 6000 && !onlooker.status().rigs[0].connected; ++i)
        std::this_thread::sleep_for(10ms);
    EXPECT_EQ(onlooker.status().rigs[0].sync.rate_hz, config.source.rate_hz);
}

TEST(RigDaemon, ServesHostsBeforeTheGpuIsSetUp) {
    RigConfig config = small_rig();
    // Only found out once there is a context: the virtual stage lends no buffers.
    config.source.buffers = "import";
    RigDaemon daemon(config);
    EXPECT_NE(daemon.endpoint(), "");
    while (daemon.running()) std::this_thread::sleep_for(5ms);
    EXPECT_THAT(thrown_sentence([&] { daemon.rethrow_failure(); }),
                testing::HasSubstr("'buffers = \"import\"'"));
}

TEST(RigDaemon, RefusesAMatcherThatThereIsNotAtOnce) {
    RigConfig config = small_rig();
    config.match.matcher = "psychic";
    EXPECT_THAT(thrown_sentence([&] { const RigDaemon daemon(config); }),
                testing::HasSubstr("no matcher named 'psychic'"));
}

TEST(RigDaemon, SetsTheGpuUpAnewAfterAResetAndCountsIt) {
    // Pictures from files: the virtual stage has a context of its own, which would be lost as well.
    const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "gpu_reset";
    std::filesystem::create_directories(folder);
    ColourImage picture(47, 61);
    cv::RNG(3).fill(picture, cv::RNG::UNIFORM, 0, 255);
    RigConfig config = small_rig();
    config.source.kind = "files";
    config.source.left = folder / "left.png";
    config.source.right = folder / "right.png";
    write_colour_image(config.source.left, picture);
    write_colour_image(config.source.right, picture);
    config.match.preset = "fast";
    RigDaemon daemon(config);
    const auto restarts = [&] {
        for (const SourceCounter& counter : daemon.status().source_counters)
            if (counter.name == "gpu_restarts") return counter.count;
        return std::uint64_t{0};
    };
    const auto published = [&] { return daemon.status().publisher.counters.published; };
    while (daemon.running() && published() == 0) std::this_thread::sleep_for(5ms);
    EXPECT_EQ(restarts(), 0u);
    reset_gpu();
    while (daemon.running() && restarts() == 0) std::this_thread::sleep_for(5ms);
    const std::uint64_t before = published();
    while (daemon.running() && published() < before + 3) std::this_thread::sleep_for(5ms);
    EXPECT_TRUE(daemon.running());
    EXPECT_EQ(restarts(), 1u);
    daemon.stop();
    daemon.rethrow_failure();
    const RigCounters counters = daemon.status().publisher.counters;
    EXPECT_EQ(counters.captured, counters.published + counters.late);
}

TEST(RigDaemon, CanBeStoppedAtAnyTime) {
    for (const auto after : {0ms, 3ms, 40ms, 150ms}) {
        RigDaemon daemon(small_rig());
        std::this_thread::sleep_for(after);
        daemon.stop();
        daemon.rethrow_failure();
        const RigCounters counters = daemon.status().publisher.counters;
        EXPECT_EQ(counters.captured, counters.published + counters.late);
        EXPECT_FALSE(daemon.running());
    }
}

TEST_P(StuckThread, IsNamed) {
    RigConfig config = small_rig();
    config.source.rate_hz = 20;
    const std::set<int> before = threads();
    RigDaemon daemon(config);
    // A shader may take long to compile; the thread is not stuck meanwhile.
    while (!daemon.status().starting.empty()) std::this_thread::sleep_for(5ms);
    EXPECT_EQ(daemon.stuck_worker(1h), "");
    {
        const HeldThread held(GetParam(), before);
        while (daemon.stuck_worker(2s).empty()) std::this_thread::sleep_for(10ms);
        EXPECT_EQ(daemon.stuck_worker(2s), GetParam());
        EXPECT_TRUE(daemon.running());
        EXPECT_EQ(daemon.stuck_worker(1h), "");
    }
    while (!daemon.stuck_worker(2s).empty()) std::this_thread::sleep_for(10ms);
    daemon.stop();
    daemon.rethrow_failure();
    EXPECT_EQ(daemon.stuck_worker(0s), "") << "threads that have ended are not stuck";
}

INSTANTIATE_TEST_SUITE_P(Workers, StuckThread, testing::Values("capture", "gpu", "publish", "sync"),
                         [](const auto& worker) { return std::string(worker.param); });

TEST(RigDaemon, WithoutACalibrationServesRawPairsToWhoAsksAndAccountsForEveryFrame) {
    RigConfig config = small_rig();
    config.uncalibrated = true;
    config.source.rate_hz = 50;
    RigDaemon daemon(config);
    const StageConfig stage = stage_of(daemon, config);
    StageReceiver films(stage);
    StageReceiver calibrates(stage, StageReceiver::Purpose::calibrate);
    std::shared_ptr<const RigFrame> pair;
    while (daemon.running() && !pair)
        if (const std::optional<FrameSet> set = calibrates.next(100ms)) pair = set->slots[0].frame;
    ASSERT_TRUE(pair);
    EXPECT_EQ(pair->content, RigFrame::Content::raw_pair);
    EXPECT_EQ(pair->colour.size(), cv::Size(61, 47));
    EXPECT_EQ(pair->right.size(), cv::Size(61, 47));
    EXPECT_EQ(pair->calibration_id, "");
    while (daemon.running() && films.status().rigs[0].refused.empty())
        std::this_thread::sleep_for(5ms);
    EXPECT_THAT(films.status().rigs[0].refused, testing::HasSubstr("no calibration yet"));
    daemon.stop();
    daemon.rethrow_failure();
    const RigCounters counters = daemon.status().publisher.counters;
    EXPECT_GT(counters.published, 0u);
    EXPECT_EQ(counters.captured, counters.published + counters.late);
}

TEST(RigDaemon, WithoutACalibrationSaysThatItKeepsNothing) {
    const TemporaryFolder folder;
    RigConfig config = small_rig();
    config.uncalibrated = true;
    config.keep.folder = folder.path() / "kept";
    RigDaemon daemon(config);
    EXPECT_THAT(daemon.status().keeps, testing::HasSubstr("keeps nothing"));
    EXPECT_FALSE(std::filesystem::exists(config.keep.folder)) << "no empty takes";
}

TEST(RigDaemon, ServesRawPairsBesideItsViews) {
    RigConfig config = small_rig();
    config.source.rate_hz = 20;
    RigDaemon daemon(config);
    const StageConfig stage = stage_of(daemon, config);
    StageReceiver films(stage);
    StageReceiver calibrates(stage, StageReceiver::Purpose::calibrate);
    std::shared_ptr<const RigFrame> pair, view;
    while (daemon.running() && !(pair && view)) {
        if (const auto set = calibrates.next(20ms)) pair = set->slots[0].frame;
        if (const auto set = films.next(20ms)) view = set->slots[0].frame;
    }
    ASSERT_TRUE(pair && view);
    EXPECT_EQ(view->content, RigFrame::Content::view);
    EXPECT_EQ(pair->content, RigFrame::Content::raw_pair);
    EXPECT_EQ(pair->calibration_id, view->calibration_id);
    daemon.stop();
    daemon.rethrow_failure();
    const RigCounters counters = daemon.status().publisher.counters;
    EXPECT_EQ(counters.captured, counters.published + counters.late);
}

TEST(RigDaemon, SaysWhyItCannotStand) {
    RigConfig config = small_rig();
    config.match.matcher = "none such";
    EXPECT_THROW(RigDaemon{config}, Error);
    config = small_rig();
    config.source.kind = "files";
    EXPECT_THROW(RigDaemon{config}, Error);
}

}  // namespace
}  // namespace vantage

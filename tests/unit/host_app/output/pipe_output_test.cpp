#include <filesystem>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "common/base/files/unique_fd.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/unit/host_app/output/given_pictures.h"
#include "tests/unit/host_app/output/probed_film.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

struct Pipe {
    Pipe() {
        int ends[2];
        if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
        reading = UniqueFd(ends[0]);
        writing = UniqueFd(ends[1]);
    }
    /// All that comes until the writers are gone.
    std::string read_all() const {
        std::string all;
        char some[65536];
        for (ssize_t got; (got = ::read(reading.get(), some, sizeof some)) > 0;)
            all.append(some, static_cast<std::size_t>(got));
        return all;
    }
    UniqueFd reading, writing;
};

class PipeOutputTest : public testing::Test {
  protected:
    Output& make(const std::string& options = "") {
        output_.emplace(
            plan_output(fmt::format("pipe:{}{}", pipe_.writing.get(), options), format_), format_,
            30);
        output_->start();
        // The output has a descriptor of its own once it is on.
        EXPECT_TRUE(wait_for([&] { return output_->state().phase == OutputPhase::on; }));
        pipe_.writing = UniqueFd();
        return *output_;
    }

    Pipe pipe_;
    OutputFormat format_{.width_px = 160, .height_px = 120, .rate_hz = 29.97};
    std::optional<Output> output_;
};

TEST_F(PipeOutputTest, GivesFfmpegEveryPictureAtItsRate) {
    if (!std::filesystem::exists("/usr/bin/ffmpeg")) GTEST_SKIP() << "SKIPPED: no ffmpeg";
    const TemporaryFolder folder;
    const std::filesystem::path film = folder.path() / "taken.mkv";
    make();
    // A pipe as a shell would make it.
    std::jthread feeder([&] {
        for (std::uint64_t tick = 0; tick < 60; ++tick) {
            wait_for([&] { return output_->state().queued < 8; });
            output_->take(given_picture(tick, 2 * static_cast<int>(tick), 160, 120));
        }
        output_->finish();
        output_.reset();
    });
    const ProgramResult result =
        run_to_end("/bin/sh", {"-c", fmt::format("exec timeout 60 ffmpeg -v error -i pipe:0 "
                                                 "-c:v ffv1 '{}' < /proc/self/fd/{}",
                                                 film.string(), pipe_.reading.get())});
    feeder.join();
    EXPECT_EQ(result.status, 0) << result.err;
    const ProbedFilm probed = probe_film(film);
    EXPECT_EQ(probed.rate.num, 30000);
    EXPECT_EQ(probed.rate.den, 1001);
    ASSERT_EQ(probed.middle_lumas.size(), 60u);
    for (int i = 0; i < 60; ++i)
        EXPECT_NEAR(probed.middle_lumas[static_cast<std::size_t>(i)], 16 + 2 * i * 219 / 255, 2)
            << i;
}

TEST_F(PipeOutputTest, WritesRawPicturesWithoutAHead) {
    make("?format=rgba");
    for (std::uint64_t tick = 0; tick < 2; ++tick)
        output_->take(given_picture(tick, 10 + static_cast<int>(tick), 160, 120));
    std::string bytes;
    std::jthread reader([&] { bytes = pipe_.read_all(); });
    output_->finish();
    output_.reset();
    reader.join();
    constexpr std::size_t picture = 160 * 120 * 4;
    ASSERT_EQ(bytes.size(), 2 * picture);
    EXPECT_EQ(bytes[0], 10);
    EXPECT_EQ(bytes[picture], 11);
    EXPECT_EQ(static_cast<unsigned char>(bytes[3]), 255);
}

TEST_F(PipeOutputTest, MakesUpForWhatAReaderWasTooSlowFor) {
    make();
    // A pipe has room for two of these pictures.
    for (std::uint64_t tick = 0; tick < 40; ++tick) {
        output_->take(given_picture(tick, static_cast<int>(tick), 160, 120));
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_GT(output_->state().dropped, 20u);
    std::atomic<std::size_t> got = 0;
    std::string bytes;
    std::jthread reader([&] {
        char some[65536];
        for (ssize_t more; (more = ::read(pipe_.reading.get(), some, sizeof some)) > 0;) {
            bytes.append(some, static_cast<std::size_t>(more));
            got = bytes.size();
        }
    });
    constexpr std::size_t picture = 6 + 160 * 120 * 3 / 2;
    EXPECT_TRUE(wait_for([&] { return got >= 40 * picture; }));
    output_->finish();
    output_.reset();
    reader.join();
    const std::size_t head = bytes.find('\n') + 1;
    EXPECT_EQ(bytes.substr(0, 10), "YUV4MPEG2 ");
    EXPECT_NE(bytes.find(" F30000:1001 "), std::string::npos);
    EXPECT_EQ(bytes.size() - head, 40 * picture) << "as many as ticks";
    EXPECT_EQ(bytes.substr(bytes.size() - 2 * picture, picture),
              bytes.substr(bytes.size() - picture))
        << "the last one again";
}

TEST_F(PipeOutputTest, AReaderThatLeavesEndsItAndNothingElse) {
    make();
    pipe_.reading = UniqueFd();
    output_->take(given_picture(0, 90, 160, 120));
    ASSERT_TRUE(wait_for([&] { return output_->state().phase == OutputPhase::failed; }));
    EXPECT_NE(output_->state().failure.find("Broken pipe"), std::string::npos)
        << output_->state().failure;
}

}  // namespace
}  // namespace vantage

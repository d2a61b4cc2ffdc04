#include "rig_firmware/keep/take_keeper.h"

#include <map>
#include <set>

#include <gtest/gtest.h>

#include "common/take/take_check.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/common/take/small_take.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

class TakeKeeperTest : public testing::Test {
  protected:
    RigConfig::Keep config() const { return {folder_.path() / "takes", 1, 1, 0.2 / 60}; }
    std::vector<std::filesystem::path> files() const {
        std::vector<std::filesystem::path> found;
        for (const auto& entry : std::filesystem::directory_iterator(config().folder))
            found.push_back(entry.path());
        return found;
    }
    static void offer(TakeKeeper& keeper, std::uint64_t pulse) {
        keeper.offer(std::make_shared<const PackedFrame>(sent_frame("north", pulse)));
    }

    TemporaryFolder folder_;
};

TEST_F(TakeKeeperTest, KeepsEveryFrameOverTheEndsOfItsFiles) {
    constexpr std::uint64_t first = 1000, most = 10000;
    std::uint64_t end = first;
    {
        TakeKeeper keeper(config(), "north", 25);
        // How soon a file can be begun is up to the disk.
        while ((files().size() < 3 || end < first + 200) && end < first + most) {
            offer(keeper, end++);
            std::this_thread::sleep_for(5ms);
        }
        EXPECT_NE(keeper.line().find("keeps"), std::string::npos);
    }
    EXPECT_GT(files().size(), 2u);
    std::map<std::uint64_t, int> seen;
    for (const auto& file : files()) {
        EXPECT_TRUE(file.filename().string().starts_with("north-2"));
        const TakeReader take(file);
        EXPECT_TRUE(take.is_ended());
        EXPECT_TRUE(check_take(take).is_whole());
        for (const TakeReader::Frame& frame : take.frames(0)) ++seen[frame.pulse];
    }
    EXPECT_EQ(seen.size(), end - first) << "none is missing";
    for (const auto& [pulse, times] : seen) EXPECT_EQ(times, 1) << pulse;
}

TEST_F(TakeKeeperTest, DropsTheOldestFilesBeyondItsRoom) {
    std::filesystem::create_directories(config().folder);
    for (const char* old : {"north-20200101T000000Z.mkv", "north-20200101T000500Z.mkv"})
        write_small_take(config().folder / old, {"north"}, 1, 20);
    write_small_take(config().folder / "south-20200101T000000Z.mkv", {"south"}, 1, 20);
    const std::uint64_t bytes =
        std::filesystem::file_size(config().folder / "north-20200101T000000Z.mkv");
    RigConfig::Keep small = config();
    small.gigabytes = 1.5 * static_cast<double>(bytes) / 1e9;
    std::filesystem::last_write_time(
        config().folder / "north-20200101T000000Z.mkv",
        std::filesystem::file_time_type::clock::now() - std::chrono::minutes(10));
    { TakeKeeper keeper(small, "north", 25); }
    EXPECT_FALSE(std::filesystem::exists(config().folder / "north-20200101T000000Z.mkv"));
    EXPECT_TRUE(std::filesystem::exists(config().folder / "north-20200101T000500Z.mkv"));
    EXPECT_TRUE(std::filesystem::exists(config().folder / "south-20200101T000000Z.mkv"))
        << "another rig's";
    small.hours = 0.1;
    std::filesystem::last_write_time(
        config().folder / "north-20200101T000500Z.mkv",
        std::filesystem::file_time_type::clock::now() - std::chrono::minutes(10));
    { TakeKeeper keeper(small, "north", 25); }
    EXPECT_FALSE(std::filesystem::exists(config().folder / "north-20200101T000500Z.mkv"));
}

TEST_F(TakeKeeperTest, LeavesWhatItHasWhereNothingIsPublished) {
    std::filesystem::create_directories(config().folder);
    write_small_take(config().folder / "north-20200101T000000Z.mkv", {"north"}, 1, 20);
    {
        TakeKeeper keeper(config(), "north", 25);
        std::this_thread::sleep_for(700ms);
        EXPECT_EQ(keeper.line().find(';'), std::string::npos) << keeper.line();
    }
    EXPECT_EQ(files().size(), 1u);
}

TEST_F(TakeKeeperTest, RefusesAFolderThatCannotBe) {
    write_bytes(folder_.path() / "takes", {});
    EXPECT_NE(thrown_sentence([&] { TakeKeeper keeper(config(), "north", 25); }).find("[keep]"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage

#include "rig_firmware/keep/take_keeper.h"

#include <map>
#include <set>

#include <gtest/gtest.h>

#include "common/take/take_check.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"
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
            if (entry.path().extension() == ".mkv") found.push_back(entry.path());
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
}

TEST_F(TakeKeeperTest, ErasesNothingByTheClockOfTheDay) {
    std::filesystem::create_directories(config().folder);
    // By the clock of this computer, as it was set then, one is days old and one of tomorrow.
    for (const auto& [name, age] : {std::pair("north-20390101T000000Z.mkv", 72h),
                                    std::pair("north-20200101T000500Z.mkv", -24h)}) {
        write_small_take(config().folder / name, {"north"}, 1, 20);
        std::filesystem::last_write_time(config().folder / name,
                                         std::filesystem::file_time_type::clock::now() - age);
    }
    TakeKeeper keeper(config(), "north", 25);
    EXPECT_EQ(files().size(), 2u);
    EXPECT_EQ(keeper.erased(), 0u);
}

TEST_F(TakeKeeperTest, ErasesInTheOrderInWhichItKeptAndSaysSo) {
    std::filesystem::create_directories(config().folder);
    const auto keep = [&](const RigConfig::Keep& how) {
        return TakeKeeper(how, "north", 25).line();
    };
    const auto add = [&](const char* name) {
        write_small_take(config().folder / name, {"north"}, 1, 20);
        keep(config());
    };
    // The clock was in 2039, and was set right then.
    add("north-20390101T000000Z.mkv");
    add("north-20260101T000000Z.mkv");
    const auto of_2039 = config().folder / "north-20390101T000000Z.mkv";
    std::filesystem::last_write_time(
        of_2039, std::filesystem::file_time_type::clock::now() + std::chrono::hours(100'000));
    RigConfig::Keep small = config();
    small.gigabytes = 1.5 * static_cast<double>(std::filesystem::file_size(of_2039)) / 1e9;
    const std::string line = keep(small);
    EXPECT_FALSE(std::filesystem::exists(of_2039)) << "it was kept first";
    EXPECT_TRUE(std::filesystem::exists(config().folder / "north-20260101T000000Z.mkv"));
    EXPECT_NE(line.find("erased 1 files, the last north-20390101T000000Z.mkv"), std::string::npos)
        << line;
}

TEST_F(TakeKeeperTest, LosesNoFrameWhenThePulsesGoBack) {
    RigConfig::Keep one_file = config();
    one_file.minutes = 10;
    {
        TakeKeeper keeper(one_file, "north", 25);
        for (std::uint64_t i = 0; i < 20; ++i) offer(keeper, 100'000 + i);
        for (std::uint64_t i = 0; i < 20; ++i) offer(keeper, 10'000 + i);
        ASSERT_TRUE(eventually([&] { return files().size() == 2; }));
    }
    std::set<std::uint64_t> pulses;
    for (const auto& file : files()) {
        const TakeReader take(file);
        for (const TakeReader::Frame& frame : take.frames(0)) pulses.insert(frame.pulse);
    }
    EXPECT_EQ(pulses.size(), 40u);
}

TEST(KeepLedger, AgesByTheTimeThatWasKept) {
    TemporaryFolder folder;
    const std::vector<KeptFile> files{{folder.path() / "north-20390101T000000Z.mkv", {}, 1}};
    KeepLedger ledger(folder.path(), "north");
    ledger.reconcile(files);
    EXPECT_EQ(ledger.age_s(ledger.entries().front()), 0);
    ledger.advance(3600);
    ledger.save();
    KeepLedger later(folder.path(), "north");
    later.reconcile(files);
    later.advance(60);
    ASSERT_EQ(later.entries().size(), 1u);
    EXPECT_NEAR(later.age_s(later.entries().front()), 3660, 1e-9);
    write_bytes(folder.path() / ".north.keep.json", {});
    EXPECT_TRUE(KeepLedger(folder.path(), "north").entries().empty()) << "it is begun anew";
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

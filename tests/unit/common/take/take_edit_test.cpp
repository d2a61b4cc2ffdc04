#include "common/take/take_edit.h"

#include <gtest/gtest.h>

#include "common/base/time/pulse_grid.h"
#include "common/take/take_check.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/common/take/small_take.h"

namespace vantage {
namespace {

constexpr std::uint64_t all = ~std::uint64_t{0};

class TakeEditTest : public testing::Test {
  protected:
    std::filesystem::path file(const char* name) const { return folder_.path() / name; }
    void expect_the_same(const TakeReader& copy, std::size_t rig, const TakeReader& of,
                         std::size_t rig_there, std::uint64_t from, std::uint64_t to) {
        std::size_t next = 0;
        for (const TakeReader::Frame& frame : of.frames(rig_there)) {
            if (frame.pulse < from || frame.pulse >= to) continue;
            ASSERT_LT(next, copy.frames(rig).size());
            const StoredFrame there = of.load(rig_there, frame),
                              here = copy.load(rig, copy.frames(rig)[next++]);
            EXPECT_EQ(here.record.pulse, there.record.pulse);
            EXPECT_EQ(here.record.header, there.record.header);
            EXPECT_EQ(here.colour, there.colour);
            EXPECT_EQ(here.depth, there.depth);
        }
        EXPECT_EQ(next, copy.frames(rig).size());
    }

    TemporaryFolder folder_;
};

TEST_F(TakeEditTest, CutsWithoutReencoding) {
    write_small_take(file("all.mkv"), {"north", "south"}, 100, 200);
    const TakeReader whole(file("all.mkv"));
    const TakeCopy copied = copy_takes({&whole}, 120, 150, file("part.mkv"));
    EXPECT_EQ(copied.frames, 60u);
    EXPECT_EQ(copied.damaged + copied.twice, 0u);
    const TakeReader part(file("part.mkv"));
    EXPECT_TRUE(part.is_ended());
    EXPECT_DOUBLE_EQ(part.duration_s(), 29 * 0.04);
    for (const std::size_t rig : {0, 1}) expect_the_same(part, rig, whole, rig, 120, 150);
    EXPECT_TRUE(check_take(part).is_whole());
    EXPECT_EQ(part.facts().origin, PulseGrid(25).time_of(120));
    EXPECT_FALSE(std::filesystem::exists(file("part.mkv.partial")));
}

TEST_F(TakeEditTest, JoinsRigsAndTimesByPulse) {
    write_small_take(file("north.mkv"), {"north"}, 100, 160);
    write_small_take(file("south.mkv"), {"south"}, 110, 140);
    write_small_take(file("later.mkv"), {"south"}, 130, 170);
    const TakeReader north(file("north.mkv")), south(file("south.mkv")), later(file("later.mkv"));
    const TakeCopy copied = copy_takes({&north, &south, &later}, 0, all, file("all.mkv"));
    EXPECT_EQ(copied.twice, 11u);
    const TakeReader joined(file("all.mkv"));
    ASSERT_EQ(joined.facts().rigs.size(), 2u);
    expect_the_same(joined, 0, north, 0, 0, all);
    ASSERT_EQ(joined.frames(1).size(), 61u);
    EXPECT_EQ(joined.frames(1).front().pulse, 110u);
    EXPECT_EQ(joined.frames(1).back().pulse, 170u);
}

TEST_F(TakeEditTest, FillsGapsFromAnotherTake) {
    write_small_take(file("host.mkv"), {"north"}, 100, 140, {120, 121, 130});
    write_small_take(file("rig.mkv"), {"north"}, 100, 140);
    const TakeReader host(file("host.mkv")), rig(file("rig.mkv"));
    ASSERT_EQ(check_take(host).gaps.size(), 2u);
    copy_takes({&host, &rig}, 0, all, file("all.mkv"));
    EXPECT_TRUE(check_take(TakeReader(file("all.mkv"))).is_whole());
}

TEST_F(TakeEditTest, LeavesDamagedFramesOutOrTakesThemFromAnotherTake) {
    write_small_take(file("good.mkv"), {"north"}, 100, 140);
    std::vector<std::byte> bytes = bytes_of_file(file("good.mkv"));
    const TakeReader good(file("good.mkv"));
    bytes[good.frames(0)[20].depth.at + 9] ^= std::byte{4};
    write_bytes(file("bad.mkv"), bytes);
    const TakeReader bad(file("bad.mkv"));
    EXPECT_EQ(copy_takes({&bad}, 0, all, file("rest.mkv")).damaged, 1u);
    EXPECT_TRUE(check_take(TakeReader(file("rest.mkv"))).damage.empty());
    EXPECT_EQ(check_take(TakeReader(file("rest.mkv"))).gaps.size(), 1u);
    copy_takes({&bad, &good}, 0, all, file("mended.mkv"));
    EXPECT_TRUE(check_take(TakeReader(file("mended.mkv"))).is_whole());
}

TEST_F(TakeEditTest, ReplacesNothingAndLeavesNothingWhereItFails) {
    write_small_take(file("all.mkv"), {"north"}, 100, 110);
    const TakeReader take(file("all.mkv"));
    const auto sentence = [&](const char* name, std::uint64_t from) {
        return thrown_sentence([&] { copy_takes({&take}, from, all, file(name)); });
    };
    EXPECT_NE(sentence("all.mkv", 0).find("never replaces a file"), std::string::npos);
    EXPECT_NE(sentence("part.mkv", 500).find("the range has no frames"), std::string::npos);
    EXPECT_NE(sentence("part.mp4", 0).find(".mkv"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(file("part.mkv")));
    EXPECT_FALSE(std::filesystem::exists(file("part.mkv.partial")));
}

TEST_F(TakeEditTest, CheckListsGapsWithReasonsAndDamage) {
    write_small_take(file("take.mkv"), {"north", "south"}, 100, 200, {130, 131, 132, 150});
    std::vector<std::byte> bytes = bytes_of_file(file("take.mkv"));
    const TakeReader before(file("take.mkv"));
    const std::uint64_t damaged_at = before.frames(0)[7].colour.at;
    bytes[damaged_at + 30] ^= std::byte{1};
    write_bytes(file("take.mkv"), bytes);
    const TakeVerdict verdict = check_take(TakeReader(file("take.mkv")));
    ASSERT_EQ(verdict.gaps.size(), 2u);
    EXPECT_EQ(verdict.gaps[0].rig, "south");
    EXPECT_EQ(verdict.gaps[0].from, 130u);
    EXPECT_EQ(verdict.gaps[0].to, 132u);
    EXPECT_EQ(verdict.gaps[1].from, 150u);
    ASSERT_EQ(verdict.damage.size(), 1u);
    EXPECT_NE(verdict.damage[0].words.find(fmt::format(
                  "rig north's colour of pulse 107, at byte {}, is damaged", damaged_at)),
              std::string::npos)
        << verdict.damage[0].words;
    EXPECT_EQ(verdict.frames, 101u + 97 - 1);
}

TEST_F(TakeEditTest, CheckReportsARigThatLeft) {
    std::vector<std::uint64_t> rest;
    for (std::uint64_t pulse = 150; pulse <= 200; ++pulse) rest.push_back(pulse);
    write_small_take(file("take.mkv"), {"north", "south"}, 100, 200, rest);
    const TakeVerdict verdict = check_take(TakeReader(file("take.mkv")));
    ASSERT_EQ(verdict.gaps.size(), 1u);
    EXPECT_EQ(verdict.gaps[0].pulses(), 51u);
    EXPECT_EQ(verdict.gaps[0].why, "the rig went earlier");
}

}  // namespace
}  // namespace vantage

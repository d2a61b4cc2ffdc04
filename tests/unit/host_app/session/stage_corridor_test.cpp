#include "host_app/session/stage_corridor.h"

#include <gtest/gtest.h>

#include "tests/unit/host_app/frames/scripted_feed.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

class StageCorridorTest : public testing::Test {
  protected:
    /// Takes a frame set at this time after the first one and returns the corridor.
    std::shared_ptr<const Corridor> after(std::chrono::milliseconds time,
                                          const std::vector<std::string>& present,
                                          Absence absence = Absence::late) {
        FrameSet set = feed_.set(1, present);
        set.complete = MonotonicTime{1h} + time;
        for (FrameSet::Slot& slot : set.slots)
            if (!slot.frame) slot.absence = absence;
        corridor_.update(set);
        return corridor_.now();
    }
    ScriptedFeed feed_{{"north", "south"}};
    StageCorridor corridor_{0.75};
};

TEST_F(StageCorridorTest, IsUnknownWithoutAnExtent) { EXPECT_FALSE(after(0ms, {"north"})); }

TEST_F(StageCorridorTest, StaysTheSameWhileTheSameRigsSendFrames) {
    corridor_.begin({});
    const auto first = after(0ms, {"north", "south"});
    ASSERT_TRUE(first);
    EXPECT_EQ(after(40ms, {"north", "south"}), first);
    EXPECT_EQ(after(80ms, {"north"}), first) << "late once";
    EXPECT_EQ(after(120ms, {"north", "south"}), first);
}

TEST_F(StageCorridorTest, LosesAnAwayRigUntilItsNextFrame) {
    corridor_.begin({});
    const auto both = after(0ms, {"north", "south"});
    EXPECT_EQ(after(1900ms, {"north"}), both);
    const auto one = after(2100ms, {"north"});
    EXPECT_NE(one, both);
    EXPECT_EQ(after(2140ms, {"north"}), one);
    EXPECT_NE(after(2180ms, {"north", "south"}), one);
}

TEST_F(StageCorridorTest, ReportsPositionsOfTheRigsAndWhichAreAway) {
    EXPECT_FALSE(corridor_.places());
    corridor_.begin({});
    after(0ms, {"north", "south"});
    ASSERT_TRUE(corridor_.places());
    ASSERT_EQ(corridor_.places()->rigs.size(), 2u);
    EXPECT_EQ(corridor_.places()->rigs[1].name, "south");
    EXPECT_FALSE(corridor_.places()->rigs[1].is_away);
    after(2100ms, {"north"});
    EXPECT_TRUE(corridor_.places()->rigs[1].is_away);
}

TEST_F(StageCorridorTest, KeepsARigThatNoFramesWereRequestedOf) {
    corridor_.begin({});
    const auto both = after(0ms, {"north", "south"});
    EXPECT_EQ(after(60s, {"north"}, Absence::not_asked), both);
}

TEST_F(StageCorridorTest, ForgetsARigThatIsRemovedFromTheStageAtOnce) {
    corridor_.begin({});
    const auto both = after(0ms, {"north", "south"});
    FrameSet set = feed_.set(2, {"north"});
    set.slots.pop_back();
    set.complete = MonotonicTime{1h} + 40ms;
    corridor_.update(set);
    EXPECT_NE(corridor_.now(), both);
    ASSERT_EQ(corridor_.places()->rigs.size(), 1u);
    EXPECT_EQ(corridor_.places()->rigs[0].name, "north");
}

}  // namespace
}  // namespace vantage

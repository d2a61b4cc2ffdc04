#include "host_app/session/stage_corridor.h"

#include <gtest/gtest.h>

#include "tests/unit/host_app/frames/scripted_feed.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

class StageCorridorTest : public testing::Test {
  protected:
    /// Of a set so long after the first one.
    std::shared_ptr<const Corridor> look(std::chrono::milliseconds time,
                                         const std::vector<std::string>& present,
                                         Absence absence = Absence::late) {
        FrameSet set = feed_.set(1, present);
        set.complete = MonotonicTime{1h} + time;
        for (FrameSet::Slot& slot : set.slots)
            if (!slot.frame) slot.absence = absence;
        corridor_.look(set);
        return corridor_.now();
    }
    ScriptedFeed feed_{{"north", "south"}};
    StageCorridor corridor_{0.75};
};

TEST_F(StageCorridorTest, IsUnknownBeforeTheStageIs) { EXPECT_FALSE(look(0ms, {"north"})); }

TEST_F(StageCorridorTest, StaysTheSameWhileTheSameRigsGiveFrames) {
    corridor_.begin({});
    const auto first = look(0ms, {"north", "south"});
    ASSERT_TRUE(first);
    EXPECT_EQ(look(40ms, {"north", "south"}), first);
    EXPECT_EQ(look(80ms, {"north"}), first) << "late once";
    EXPECT_EQ(look(120ms, {"north", "south"}), first);
}

TEST_F(StageCorridorTest, LosesARigThatIsAwayAndGetsItBack) {
    corridor_.begin({});
    const auto both = look(0ms, {"north", "south"});
    EXPECT_EQ(look(1900ms, {"north"}), both);
    const auto one = look(2100ms, {"north"});
    EXPECT_NE(one, both);
    EXPECT_EQ(look(2140ms, {"north"}), one);
    EXPECT_NE(look(2180ms, {"north", "south"}), one);
}

TEST_F(StageCorridorTest, SaysWhereTheRigsStandAndWhichIsAway) {
    EXPECT_FALSE(corridor_.places());
    corridor_.begin({});
    look(0ms, {"north", "south"});
    ASSERT_TRUE(corridor_.places());
    ASSERT_EQ(corridor_.places()->rigs.size(), 2u);
    EXPECT_EQ(corridor_.places()->rigs[1].name, "south");
    EXPECT_FALSE(corridor_.places()->rigs[1].is_away);
    look(2100ms, {"north"});
    EXPECT_TRUE(corridor_.places()->rigs[1].is_away);
}

TEST_F(StageCorridorTest, KeepsARigThatWasAskedForNoFrames) {
    corridor_.begin({});
    const auto both = look(0ms, {"north", "south"});
    EXPECT_EQ(look(60s, {"north"}, Absence::not_asked), both);
}

}  // namespace
}  // namespace vantage

#include "host_app/replay/replay.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using Action = ReplayAction;

constexpr double rate_hz = 25;

/// A stage with 25 pulses per second, whose buffer has the pulses 1000 to 2000.
class ReplayTest : public testing::Test {
  protected:
    ReplayTest() : replay_(Transport(), empty_book()) {}

    static ClipBook empty_book() {
        ClipBook book;
        book.pulse_rate_hz = rate_hz;
        return book;
    }
    void give(const TransportInput& input) { replay_.take(input, shown_, span_); }
    void ask(Action action, int number = 0, const std::string& words = {}) {
        give({.commands = {ReplayCall{action, number, words}}});
    }
    /// Passes so many ticks of the length of a pulse.
    void pass(int ticks) {
        for (int i = 0; i < ticks; ++i) {
            replay_.advance(1 / rate_hz, rate_hz, span_);
            give({});
            if (const auto pulse = replay_.transport().pulse())
                shown_ = static_cast<std::uint64_t>(*pulse);
        }
    }
    void make_clip(std::uint64_t in, std::uint64_t out) {
        shown_ = in;
        give({.commands = {command::MarkIn{}}});
        shown_ = out;
        give({.commands = {command::MarkOut{}}});
        ask(Action::make_clip);
    }
    /// Makes clips 1 to 3 of 10 pulses each, and a list of all of them.
    void make_list() {
        for (const std::uint64_t in : {1100, 1200, 1300}) {
            make_clip(in, in + 10);
            ask(Action::add_entry);
        }
        ask(Action::select_entry, 1);
    }
    ReplayState state() const { return replay_.state(); }
    double pulse() const { return replay_.transport().pulse().value_or(-1); }
    const Clip& clip(int number) const { return replay_.book().clips.at(number); }
    std::vector<int> list() const {
        std::vector<int> clips;
        for (const PlayEntry& entry : replay_.book().list) clips.push_back(entry.clip);
        return clips;
    }

    Replay replay_;
    std::optional<PastFrameSets::Span> span_ = PastFrameSets::Span{.oldest = 1000, .newest = 2000};
    std::uint64_t shown_ = 2000;
};

TEST_F(ReplayTest, MakesAClipFromMarkToMarkAndStaysLive) {
    make_clip(1500, 1525);
    EXPECT_EQ(clip(1).in, 1500u);
    EXPECT_EQ(clip(1).out, 1525u) << "the first pulse that is left out";
    EXPECT_EQ(clip(1).speed, 1);
    EXPECT_EQ(state().hand, 1);
    EXPECT_EQ(state().mode, ReplayMode::live);
    shown_ = 1600;
    give({.commands = {command::MarkIn{}}});
    shown_ = 1650;
    ask(Action::make_clip);
    EXPECT_EQ(clip(2).out, 1650u) << "without an out mark the clip ends at the pulse on screen";
}

TEST_F(ReplayTest, MarksThePositionBeforeItsFrameIsShown) {
    shown_ = 1990;
    give({.to_pulse = 1200});
    give({.commands = {command::MarkIn{}}});
    give({.to_pulse = 1250.7});
    ask(Action::make_clip);
    EXPECT_EQ(clip(1).in, 1200u);
    EXPECT_EQ(clip(1).out, 1250u);
}

TEST_F(ReplayTest, ReportsWhyNoClipWasMade) {
    ask(Action::make_clip);
    EXPECT_NE(state().notice.find("set the in mark"), std::string::npos) << state().notice;
    shown_ = 1500;
    give({.commands = {command::MarkIn{}}});
    ask(Action::make_clip);
    EXPECT_NE(state().notice.find("out mark"), std::string::npos) << state().notice;
    EXPECT_TRUE(replay_.book().clips.empty());
    for (const Action action : {Action::cue_clip, Action::delete_clip, Action::add_entry,
                                Action::play_list, Action::last_cue}) {
        const std::uint64_t before = state().notices;
        ask(action);
        EXPECT_EQ(state().notices, before + 1);
    }
    ask(Action::hold_clip, 7);
    EXPECT_NE(state().notice.find("no clip 7"), std::string::npos) << state().notice;
}

TEST_F(ReplayTest, PlaysAClipToTheFrameBeforeItsOutAndStops) {
    make_clip(1500, 1510);
    ask(Action::play_clip);
    EXPECT_EQ(state().mode, ReplayMode::clip);
    EXPECT_EQ(pulse(), 1500);
    pass(9);
    EXPECT_EQ(pulse(), 1509);
    EXPECT_DOUBLE_EQ(*state().clip_left_s, 1 / rate_hz);
    pass(5);
    EXPECT_EQ(pulse(), 1509) << "the out frame is excluded";
    EXPECT_EQ(replay_.transport().state().speed, 0);
    EXPECT_EQ(*state().clip_left_s, 0);
}

TEST_F(ReplayTest, CuedClipStandsAtItsInAndPlaysAtItsSpeed) {
    make_clip(1500, 1510);
    ask(Action::clip_speed, 50);
    ask(Action::cue_clip);
    pass(5);
    EXPECT_EQ(pulse(), 1500);
    EXPECT_DOUBLE_EQ(*state().clip_left_s, 10 / rate_hz / 0.5);
    give({.commands = {command::ToggleHold{}}});
    pass(4);
    EXPECT_EQ(pulse(), 1502);
    ask(Action::clip_speed, 100);
    pass(1);
    EXPECT_EQ(pulse(), 1503) << "a clip that is playing takes its new speed at once";
}

TEST_F(ReplayTest, JogStaysWithinTheGuardBands) {
    make_clip(1500, 1510);
    ask(Action::cue_clip);
    give({.pulses = -30});
    EXPECT_EQ(pulse(), 1470);
    give({.pulses = -100});
    EXPECT_EQ(pulse(), 1450) << "2 s before the in";
    give({.pulses = +1000});
    EXPECT_EQ(pulse(), 1509 + 50);
    EXPECT_EQ(state().mode, ReplayMode::clip);
    give({.to_pulse = 1800});
    EXPECT_EQ(pulse(), 1800);
    EXPECT_EQ(state().mode, ReplayMode::past) << "a seek leaves the clip";
}

TEST_F(ReplayTest, MarksBelongToTheClipUntilItIsLeft) {
    make_clip(1500, 1510);
    make_clip(1700, 1710);
    ask(Action::hold_clip, 1);
    ask(Action::cue_clip);
    EXPECT_EQ(replay_.transport().state().in, 1500u);
    give({.pulses = 3});
    shown_ = 1503;
    give({.commands = {command::MarkIn{}}});
    ask(Action::trim_clip);
    EXPECT_EQ(clip(1).in, 1503u);
    give({.commands = {command::ToLive{}}});
    EXPECT_EQ(state().mode, ReplayMode::live);
    EXPECT_EQ(replay_.transport().state().in, 1700u);
    EXPECT_EQ(replay_.transport().state().out, 1710u);
}

TEST_F(ReplayTest, ReturnsToTheStartOfTheLastPlayback) {
    give({.to_pulse = 1200});
    give({.commands = {command::ToggleHold{}}});
    pass(40);
    EXPECT_EQ(pulse(), 1240);
    give({.commands = {command::ToLive{}}});
    EXPECT_EQ(state().mode, ReplayMode::live);
    ask(Action::last_cue);
    EXPECT_EQ(pulse(), 1200);
    EXPECT_EQ(replay_.transport().state().speed, 0);
    give({.commands = {command::ToLive{}}});
    make_clip(1500, 1510);
    ask(Action::play_clip);
    pass(5);
    give({.commands = {command::ToLive{}}});
    ask(Action::last_cue);
    EXPECT_EQ(pulse(), 1500);
    EXPECT_EQ(state().mode, ReplayMode::clip);
    span_->oldest = 1600;
    give({.commands = {command::ToLive{}}});
    ask(Action::last_cue);
    EXPECT_EQ(state().mode, ReplayMode::live);
    EXPECT_NE(state().notice.find("has left the replay buffer"), std::string::npos);
}

TEST_F(ReplayTest, ProgrammeSpeedTogglesAPreset) {
    ask(Action::preset_speed, 25);
    give({.to_pulse = 1200});
    ask(Action::programme_speed);
    EXPECT_TRUE(state().is_at_programme_speed);
    pass(8);
    EXPECT_EQ(pulse(), 1202);
    ask(Action::preset_speed, 50);
    pass(2);
    EXPECT_EQ(pulse(), 1203) << "playback at the programme speed follows the preset";
    ask(Action::programme_speed);
    EXPECT_EQ(replay_.transport().state().speed, 1);
    ask(Action::last_cue);
    EXPECT_EQ(pulse(), 1200);
}

TEST_F(ReplayTest, FastJogScalesTheJogButNotTheShuttle) {
    give({.to_pulse = 1500});
    ask(Action::fast_jog);
    give({.pulses = -2});
    EXPECT_EQ(pulse(), 1480);
    give({.shuttle_pulses = 3});
    EXPECT_EQ(pulse(), 1483);
    ask(Action::fast_jog);
    give({.pulses = 1});
    EXPECT_EQ(pulse(), 1484);
}

TEST_F(ReplayTest, PlaysAListWithoutGaps) {
    make_list();
    ask(Action::play_list);
    std::vector<std::uint64_t> shown{shown_ = 1100};
    for (int i = 0; i < 31; ++i) {
        pass(1);
        shown.push_back(shown_);
    }
    std::vector<std::uint64_t> expected;
    for (const std::uint64_t in : {1100, 1200, 1300})
        for (std::uint64_t i = 0; i < 10; ++i) expected.push_back(in + i);
    expected.insert(expected.end(), 2, 1309);
    EXPECT_EQ(shown, expected) << "and stops at the end";
    EXPECT_EQ(*state().list_left_s, 0);
    ask(Action::add_entry);
    pass(3);
    EXPECT_EQ(shown_, 1309u) << "an entry that is added after the end does not start by itself";
}

TEST_F(ReplayTest, CarriesExcessTimeIntoTheNextEntry) {
    make_list();
    ask(Action::entry_speed, 75);
    ask(Action::play_list);
    pass(14);
    // 14 ticks are 10.5 pulses at 0.75, so two thirds of a tick are left for the next entry.
    EXPECT_NEAR(pulse(), 1200 + 2.0 / 3, 1e-6);
}

TEST_F(ReplayTest, LoopingListStartsAgain) {
    make_list();
    ask(Action::loop_list);
    ask(Action::play_list);
    pass(30);
    EXPECT_EQ(pulse(), 1100);
    EXPECT_EQ(state().playing, 0u);
}

TEST_F(ReplayTest, ListCanBeEditedWhileItPlays) {
    make_list();
    ask(Action::play_list);
    pass(3);
    ask(Action::select_entry, 2);
    ask(Action::swap_entry, 3);
    EXPECT_EQ(list(), (std::vector{1, 3, 2}));
    EXPECT_EQ(pulse(), 1103) << "the edit does not interrupt playback";
    pass(7);
    EXPECT_EQ(pulse(), 1300);
    ask(Action::select_entry, 2);
    ask(Action::move_entry, -1);
    EXPECT_EQ(list(), (std::vector{3, 1, 2}));
    EXPECT_EQ(state().playing, 0u);
    ask(Action::hold_clip, 2);
    ask(Action::add_entry);
    EXPECT_EQ(list(), (std::vector{3, 2, 1, 2}));
    ask(Action::next_entry);
    EXPECT_EQ(pulse(), 1200);
    EXPECT_EQ(state().playing, 1u);
    ask(Action::select_entry, 4);
    ask(Action::remove_entry);
    EXPECT_EQ(list(), (std::vector{3, 2, 1}))
        << "an entry that is not playing needs no confirmation";
    EXPECT_DOUBLE_EQ(*state().list_left_s, 20 / rate_hz);
}

TEST_F(ReplayTest, AsksBeforeItRemovesThePlayingEntry) {
    make_list();
    ask(Action::play_list);
    pass(2);
    ask(Action::remove_entry);
    EXPECT_EQ(list().size(), 3u);
    EXPECT_NE(state().question.find("entry 1, which is playing"), std::string::npos);
    ask(Action::remove_entry);
    EXPECT_EQ(list(), (std::vector{2, 3}));
    EXPECT_EQ(pulse(), 1200) << "the entry in its place";
    EXPECT_EQ(state().question, "");
    ask(Action::loop_list);
    ask(Action::remove_entry);
    // Four times through the list, which takes longer than the question is open.
    pass(80);
    ask(Action::remove_entry);
    EXPECT_EQ(list().size(), 2u) << "it asks again";
}

TEST_F(ReplayTest, DeletingAClipAsksAndRemovesItsEntries) {
    make_list();
    ask(Action::play_list);
    pass(2);
    ask(Action::hold_clip, 1);
    ask(Action::delete_clip);
    EXPECT_NE(
        state().question.find("delete clip 1, which is playing, which is in the play list once"),
        std::string::npos)
        << state().question;
    ask(Action::delete_clip);
    EXPECT_FALSE(replay_.book().clips.contains(1));
    EXPECT_EQ(list(), (std::vector{2, 3}));
    EXPECT_EQ(pulse(), 1200);
    EXPECT_EQ(state().hand, 2);
    give({.commands = {command::ToLive{}}});
    for (const int number : {2, 3}) {
        ask(Action::hold_clip, number);
        ask(Action::delete_clip);
        ask(Action::delete_clip);
    }
    EXPECT_TRUE(replay_.book().clips.empty());
    EXPECT_TRUE(list().empty());
    EXPECT_EQ(state().hand, 0);
    make_clip(1500, 1510);
    EXPECT_EQ(state().hand, 1) << "the lowest free number";
}

TEST_F(ReplayTest, DoesNotPlayAClipThatLeftTheBuffer) {
    make_clip(1100, 1110);
    span_->oldest = 1105;
    ask(Action::cue_clip);
    EXPECT_NE(state().notice.find("a part of clip 1 is not in the replay buffer"),
              std::string::npos);
    EXPECT_EQ(pulse(), 1105);
    give({.commands = {command::ToLive{}}});
    span_->oldest = 1110;
    ask(Action::cue_clip);
    EXPECT_EQ(state().notice, "clip 1 is not in the replay buffer");
    EXPECT_EQ(state().mode, ReplayMode::live);
    EXPECT_EQ(presence_of(clip(1), span_), ClipPresence::gone);
}

TEST_F(ReplayTest, ClipThatLeavesTheBufferIsHeldAndReported) {
    make_clip(1100, 1110);
    ask(Action::clip_speed, 1);
    ask(Action::play_clip);
    pass(2);
    span_ = PastFrameSets::Span{.oldest = 1105, .newest = 2105};
    pass(1);
    EXPECT_NE(state().notice.find("the beginning of clip 1 has left"), std::string::npos);
    span_ = PastFrameSets::Span{.oldest = 1200, .newest = 2200};
    pass(1);
    EXPECT_TRUE(replay_.transport().is_held()) << "the last picture";
    EXPECT_FALSE(replay_.transport().pulse());
    EXPECT_NE(state().notice.find("its last picture is held"), std::string::npos);
}

TEST_F(ReplayTest, StandingFrameStaysAfterTheBufferDropsIt) {
    make_clip(1100, 1110);
    ask(Action::cue_clip);
    shown_ = 1100;
    span_->oldest = 1101;
    give({});
    EXPECT_TRUE(replay_.transport().is_held());
    EXPECT_EQ(state().mode, ReplayMode::live) << "held, and not in the past";
    EXPECT_NE(state().notice.find("clip 1 has left"), std::string::npos);
}

TEST_F(ReplayTest, ListSkipsLostClipsAndReportsThem) {
    make_list();
    ask(Action::select_entry, 2);
    span_->oldest = 1220;
    ask(Action::play_list);
    EXPECT_EQ(pulse(), 1300);
    EXPECT_EQ(state().playing, 2u);
    EXPECT_EQ(state().notice, "clip 2 is not in the replay buffer");
}

TEST_F(ReplayTest, ReportsTheShotOfAClipThatStarts) {
    make_list();
    ask(Action::hold_clip, 2);
    ask(Action::clip_shot, 4);
    EXPECT_FALSE(replay_.take_shot());
    ask(Action::play_list);
    EXPECT_FALSE(replay_.take_shot()) << "clip 1 has no shot";
    pass(10);
    EXPECT_EQ(replay_.take_shot(), 4);
    EXPECT_FALSE(replay_.take_shot()) << "once";
    give({.commands = {command::ToLive{}}});
    EXPECT_FALSE(replay_.take_shot()) << "returning to live moves no camera";
    ask(Action::clip_shot, 4);
    EXPECT_EQ(clip(2).shot, 0);
}

TEST(ReplayOfATake, HasNoLiveAndStartsWithItsBook) {
    ClipBook book;
    book.pulse_rate_hz = rate_hz;
    book.clips[3] = {.in = 30, .out = 40, .speed = 0.5};
    book.list = {{.clip = 3}, {.clip = 3, .speed = 2}};
    Replay replay(Transport::of_take(10, 1), book);
    const std::optional<PastFrameSets::Span> span = PastFrameSets::Span{.oldest = 0, .newest = 100};
    EXPECT_EQ(replay.state().mode, ReplayMode::past);
    EXPECT_EQ(replay.state().hand, 3);
    replay.take({.commands = {ReplayCall{ReplayAction::play_list}}}, 10, span);
    EXPECT_DOUBLE_EQ(*replay.state().list_left_s, 10 / rate_hz / 0.5 + 10 / rate_hz / 2);
    replay.take({.commands = {command::ToLive{}}}, 30, span);
    EXPECT_EQ(replay.state().mode, ReplayMode::past);
    EXPECT_EQ(replay.transport().state().speed, 1);
    EXPECT_EQ(replay.transport().pulse(), 30) << "at normal speed from its position";
    replay.take({.commands = {ReplayCall{ReplayAction::last_cue}}}, 30, span);
    EXPECT_EQ(replay.state().mode, ReplayMode::list);
}

}  // namespace
}  // namespace vantage

#include "host_app/output/output_supervisor.h"

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "host_app/output/media/picture_encoder.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/output/given_pictures.h"
#include "tests/unit/host_app/output/probed_film.h"

namespace vantage {
namespace {

class OutputSupervisorTest : public testing::Test {
  protected:
    std::string at(const std::string& name) const { return (folder_.path() / name).string(); }
    OutputSupervisor::Settings settings(const std::vector<std::string>& urls,
                                        const std::string& encoder = "libx264") const {
        return {.format = {.width_px = 64, .height_px = 48, .rate_hz = 25, .encoder = encoder},
                .pulse_rate_hz = 25,
                .urls = urls};
    }
    static void give(OutputSupervisor& desk, PictureSink& sink, std::uint64_t from,
                     std::uint64_t count) {
        for (std::uint64_t i = 0; i < count; ++i) {
            ASSERT_TRUE(wait_for([&] {
                for (const OutputState& state : desk.states())
                    if (state.queued >= 8) return false;
                return true;
            }));
            sink.take(given_picture(from + i));
        }
    }
    TemporaryFolder folder_;
};

TEST_F(OutputSupervisorTest, GivesEveryOutputTheCleanPicture) {
    OutputSupervisor desk(settings({at("a.mkv"), at("b.mp4")}));
    const auto sink = desk.sink();
    EXPECT_EQ(sink->name(), "") << "they have stats of their own";
    give(desk, *sink, 0, 20);
    desk.finish();
    for (const char* name : {"a.mkv", "b.mp4"}) {
        const ProbedFilm film = probe_film(at(name));
        ASSERT_EQ(film.middle_lumas.size(), 20u);
        // The overlay would be red: 63.
        for (const std::uint8_t luma : film.middle_lumas) EXPECT_NEAR(luma, 16 + 90 * 219 / 255, 2);
    }
}

TEST_F(OutputSupervisorTest, EachIsBegunEndedAndFailsByItself) {
    OutputSupervisor desk(settings({at("a.mkv"), "v4l2:/dev/no-such-video"}));
    const auto sink = desk.sink();
    ASSERT_TRUE(wait_for([&] { return desk.states()[1].phase == OutputPhase::failed; }));
    give(desk, *sink, 0, 5);
    const std::size_t third = desk.add(at("c.mkv"));
    EXPECT_EQ(third, 2u);
    give(desk, *sink, 5, 5);
    desk.stop(0);
    ASSERT_TRUE(wait_for([&] { return desk.states()[0].phase == OutputPhase::off; }));
    EXPECT_FALSE(desk.is_wanted(0));
    give(desk, *sink, 10, 5);
    desk.finish();
    const std::vector<OutputState> states = desk.states();
    EXPECT_EQ(states[0].pictures, 10u);
    EXPECT_EQ(states[0].failure, "");
    EXPECT_EQ(states[1].pictures, 0u);
    EXPECT_NE(states[1].failure, "");
    EXPECT_EQ(states[2].pictures, 10u);
    EXPECT_EQ(probe_film(at("a.mkv")).times_s.size(), 10u);
    EXPECT_EQ(probe_film(at("c.mkv")).times_s.size(), 10u);
    EXPECT_NE(thrown_sentence([&] { desk.add("srt://nowhere"); }), "");
}

TEST_F(OutputSupervisorTest, OneMayWaitUntilItIsAskedFor) {
    OutputSupervisor desk(settings({at("a.mkv") + "?start=off"}));
    const auto sink = desk.sink();
    give(desk, *sink, 0, 5);
    EXPECT_EQ(desk.states()[0].phase, OutputPhase::off);
    EXPECT_FALSE(std::filesystem::exists(at("a.mkv")));
    desk.start(0);
    give(desk, *sink, 5, 5);
    desk.finish();
    EXPECT_EQ(desk.states()[0].dropped, 0u);
    EXPECT_EQ(probe_film(at("a.mkv")).times_s.size(), 5u);
    EXPECT_NE(thrown_sentence([&] { desk.add(at("b.mkv") + "?start=later"); }).find("on or off"),
              std::string::npos);
}

TEST_F(OutputSupervisorTest, RefusesWhatCannotBeTogether) {
    EXPECT_NE(thrown_sentence([&] {
                  OutputSupervisor::check(settings({at("a.mkv"), at("a.mkv")}));
              }).find("two outputs"),
              std::string::npos);
    const std::string sentence =
        thrown_sentence([&] { OutputSupervisor::check(settings({at("a.mkv")}, "libx265")); });
    EXPECT_NE(sentence.find("'libx264'"), std::string::npos) << sentence;
    EXPECT_FALSE(std::filesystem::exists(at("a.mkv"))) << "nothing is opened";
}

TEST_F(OutputSupervisorTest, KnowsWhetherTheStandardOutputIsOneOfThem) {
    EXPECT_FALSE(OutputSupervisor(settings({})).takes_stdout());
    EXPECT_FALSE(OutputSupervisor(settings({"udp://127.0.0.1:5999"})).takes_stdout());
}

TEST_F(OutputSupervisorTest, EncodesByTheFirstEncoderThatWorksAndNamesIt) {
    testing::internal::CaptureStderr();
    OutputSupervisor desk(settings({at("a.mkv")}, ""));
    const std::string log = testing::internal::GetCapturedStderr();
    const std::string chosen = desk.states()[0].encoder;
    EXPECT_NE(log.find("pictures are encoded by " + chosen), std::string::npos) << log;
    // Whatever stands before it in the list was tried, and the log says why it is not taken.
    for (const std::string& name : known_encoders()) {
        if (name == chosen) break;
        EXPECT_NE(log.find(name + ": "), std::string::npos) << log;
    }
    give(desk, *desk.sink(), 0, 3);
    desk.finish();
    EXPECT_EQ(probe_film(at("a.mkv")).times_s.size(), 3u);
}

TEST_F(OutputSupervisorTest, TakesTheEncoderThatItIsTold) {
    OutputSupervisor desk(settings({at("a.mkv")}, "mpeg4"));
    give(desk, *desk.sink(), 0, 3);
    desk.finish();
    EXPECT_EQ(desk.states()[0].encoder, "mpeg4");
    EXPECT_EQ(probe_film(at("a.mkv")).codec, "mpeg4");
}

using namespace std::chrono_literals;

class OutputSwitchTest : public testing::Test {
  protected:
    OutputSwitchTest()
        : desk_({.format = {.width_px = 64, .height_px = 48, .encoder = "libx264"},
                 .urls = {"udp://127.0.0.1:5998", "udp://127.0.0.1:5999"}}),
          switch_(desk_) {}
    OutputSupervisor desk_;
    OutputSwitch switch_;
    const MonotonicTime now_ = MonotonicClock::now();
};

TEST_F(OutputSwitchTest, AsksBeforeItStopsAnOutput) {
    switch_.press(2, now_);
    EXPECT_TRUE(desk_.is_wanted(1));
    EXPECT_EQ(switch_.question(now_), "Press F6 again to stop udp://127.0.0.1:5999");
    switch_.press(2, now_ + 1s);
    EXPECT_FALSE(desk_.is_wanted(1));
    EXPECT_TRUE(desk_.is_wanted(0));
    EXPECT_EQ(switch_.question(now_ + 1s), "");
}

TEST_F(OutputSwitchTest, StartsAnOutputAtOnce) {
    desk_.stop(0);
    switch_.press(1, now_);
    EXPECT_TRUE(desk_.is_wanted(0));
    EXPECT_EQ(switch_.question(now_), "");
}

TEST_F(OutputSwitchTest, ForgetsAPressAfterThreeSecondsOrAnotherKey) {
    switch_.press(1, now_);
    EXPECT_EQ(switch_.question(now_ + 4s), "");
    switch_.press(1, now_ + 4s);
    EXPECT_TRUE(desk_.is_wanted(0)) << "it is asked anew";
    switch_.press(2, now_ + 5s);
    switch_.press(1, now_ + 6s);
    EXPECT_TRUE(desk_.is_wanted(0));
    EXPECT_TRUE(desk_.is_wanted(1));
}

TEST_F(OutputSwitchTest, ReportsAnOutputThatDoesNotExist) {
    for (const int number : {0, -1, 8, 3}) switch_.press(number, now_);
    EXPECT_EQ(switch_.question(now_), "There is no output 3; add it with --output");
    EXPECT_EQ(switch_.question(now_ + 4s), "");
}

}  // namespace

}  // namespace vantage

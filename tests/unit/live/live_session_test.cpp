#include "host_app/live/live_session.h"

#include <csignal>

#include <gtest/gtest.h>
#include <unistd.h>

#include "common/gl/egl_context.h"
#include "common/image/image_file.h"
#include "host_app/live/headless_flight.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/sets/scripted_feed.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

class LiveSessionTest : public testing::Test {
  protected:
    LiveSessionTest() {
        // At the rigs' own place, which sees the wall through and through.
        view_.distance_m = 4.5;
        view_.field_of_view_rad = 1.0;
    }
    LiveSession session() { return LiveSession(settings_, shaders_, feed_.feed()); }
    static cv::Vec4b middle(const ColourImage& picture) {
        return picture(picture.rows / 2, picture.cols / 2);
    }

    EglContext context_;
    ShaderLibrary shaders_;
    StopSignal stop_;
    TemporaryFolder folder_;
    ScriptedFeed feed_{{"north", "south"}};
    LiveSettings settings_{
        .width_px = 64, .height_px = 48, .rate_hz = 50, .film = {}, .contact_sheet = {}};
    OrbitView view_;
};

TEST_F(LiveSessionTest, ShowsTheNewestSet) {
    LiveSession session = this->session();
    feed_.push(feed_.set(1, {"north", "south"}, {200, 100, 50, 255}));
    session.wait_for_rigs(10s, stop_);
    session.make_picture(view_, 0ns);
    EXPECT_NEAR(middle(session.last_picture())[0], 200, 2);
    feed_.push(feed_.set(2, {"north", "south"}, {20, 100, 50, 255}));
    for (int i = 1; session.sets_shown() < 2 && i < 1000; ++i) session.make_picture(view_, i * 1ms);
    EXPECT_EQ(session.shown()->trigger_index, 2u);
    EXPECT_NEAR(middle(session.last_picture())[0], 20, 2);
}

TEST_F(LiveSessionTest, FreezesTheInstantAndNotTheFlight) {
    LiveSession session = this->session();
    feed_.push(feed_.set(1, {"north", "south"}));
    session.wait_for_rigs(10s, stop_);
    session.set_frozen(true);
    feed_.push(feed_.set(2, {"north", "south"}));
    while (!feed_.drained()) std::this_thread::sleep_for(1ms);
    std::this_thread::sleep_for(20ms);
    session.make_picture(view_, 0ns);
    const ColourImage before = session.last_picture();
    view_.azimuth_rad = 0.4;
    session.make_picture(view_, 1ms);
    EXPECT_EQ(session.shown()->trigger_index, 1u);
    EXPECT_GT(cv::norm(before, session.last_picture(), cv::NORM_INF), 20);
    session.set_frozen(false);
    session.make_picture(view_, 2ms);
    EXPECT_EQ(session.shown()->trigger_index, 2u);
}

TEST_F(LiveSessionTest, GoesBackThroughThePastAndToLiveAgain) {
    settings_.past_bytes = 100'000'000;
    settings_.pulse_rate_hz = 10;
    LiveSession session = this->session();
    const auto red_at = [&](std::uint64_t k) { return static_cast<std::uint8_t>(20 * k); };
    const auto push = [&](std::uint64_t k) {
        feed_.push(feed_.set(k, {"north", "south"}, {red_at(k), 100, 50, 255}));
        while (!feed_.drained()) std::this_thread::sleep_for(1ms);
        std::this_thread::sleep_for(20ms);
    };
    for (std::uint64_t k = 1; k <= 5; ++k) push(k);
    session.wait_for_rigs(10s, stop_);
    std::chrono::nanoseconds time = 0ns;
    const auto expect_shown = [&](std::uint64_t k) {
        session.make_picture(view_, time += 1ms);
        EXPECT_EQ(session.shown()->trigger_index, k);
        EXPECT_NEAR(middle(session.last_picture())[0], red_at(k), 2) << k;
    };
    expect_shown(5);
    EXPECT_FALSE(session.behind_s());
    session.travel(-2);
    expect_shown(3);
    EXPECT_NEAR(*session.behind_s(), 0.2, 1e-9);
    push(6);
    expect_shown(3);
    EXPECT_NEAR(*session.behind_s(), 0.3, 1e-9) << "it stands while the stage goes on";
    session.travel(0.4);
    expect_shown(3);
    session.travel(0.7);
    expect_shown(4);
    session.travel(-100);
    expect_shown(1);
    session.travel(+100);
    expect_shown(6);
    session.travel(-1);
    expect_shown(5);
    session.to_live();
    push(7);
    expect_shown(7);
    EXPECT_FALSE(session.behind_s());
    session.finish();
    const LiveReport report = session.report();
    EXPECT_EQ(report.sets_closed, report.sets_fused + report.sets_superseded + report.sets_dropped)
        << "what is looked at again is not counted again";
}

TEST_F(LiveSessionTest, ShowsTheRigsOfThePixelsWhileThatIsAskedFor) {
    LiveSession session = this->session();
    feed_.push(feed_.set(1, {"north", "south"}, {90, 90, 90, 255}));
    session.wait_for_rigs(10s, stop_);
    session.make_picture(view_, 0ns);
    EXPECT_FALSE(session.last_shares());
    session.set_novelty(true);
    session.make_picture(view_, 1ms);
    const cv::Vec4b shown = middle(session.last_picture());
    EXPECT_GT(std::max({shown[0], shown[1], shown[2]}) - std::min({shown[0], shown[1], shown[2]}),
              20)
        << "a rig's colour over a grey wall";
    const std::optional<NoveltyShares> shares = session.last_shares();
    ASSERT_TRUE(shares);
    EXPECT_EQ(shares->rigs.size(), 2u);
    EXPECT_NEAR(shares->rigs.at("north") + shares->rigs.at("south") + shares->filled, 1, 1e-6);
    ASSERT_EQ(session.novelty_legend().size(), 2u);
    while (session.synthesiser() != "points") session.next_synthesiser();
    session.make_picture(view_, 2ms);
    EXPECT_FALSE(session.last_shares()) << "points cannot tell";
    session.finish();
    EXPECT_FALSE(to_json(session.report()).contains("novelty"));
}

TEST_F(LiveSessionTest, PutsTheEyesOfAStereoscopicPictureSideBySide) {
    settings_.stereoscopy = Stereoscopy{};
    settings_.novelty = true;
    LiveSession session = this->session();
    feed_.push(feed_.set(1, {"north", "south"}, {200, 200, 200, 255}));
    session.wait_for_rigs(10s, stop_);
    session.make_picture(view_, 0ns);
    const ColourImage picture = session.last_picture();
    EXPECT_EQ(picture.size(), cv::Size(64, 48));
    EXPECT_GE(picture(24, 16)[3], 128) << "the middle of the left eye's half";
    EXPECT_GE(picture(24, 48)[3], 128) << "of the right eye's";
    ASSERT_TRUE(session.last_shares());
    session.finish();
    const nlohmann::ordered_json json = to_json(session.report());
    EXPECT_EQ(json["stereoscopic"]["convergence_m"], 4.5);
    EXPECT_GT(json["stereoscopic"]["interaxial_m"], 0.05);
}

TEST_F(LiveSessionTest, RefusesAStereoscopicPictureOfAnOddWidth) {
    settings_.stereoscopy = Stereoscopy{};
    settings_.width_px = 65;
    const std::string sentence = thrown_sentence([&] { session(); });
    EXPECT_NE(sentence.find("65 px is odd"), std::string::npos) << sentence;
}

TEST_F(LiveSessionTest, RefusesANoveltyOverlayOfWhatCannotTell) {
    settings_.novelty = true;
    settings_.synthesiser = "points";
    const std::string sentence = thrown_sentence([&] { session(); });
    EXPECT_NE(sentence.find("'points' cannot tell"), std::string::npos) << sentence;
}

TEST_F(LiveSessionTest, StaysLiveWhereNoPastIsKept) {
    LiveSession session = this->session();
    feed_.push(feed_.set(1, {"north", "south"}));
    session.wait_for_rigs(10s, stop_);
    session.travel(-3);
    EXPECT_FALSE(session.keeps_past());
    EXPECT_FALSE(session.behind_s());
}

TEST_F(LiveSessionTest, GoesOnWithTheRigsThatCame) {
    LiveSession session = this->session();
    feed_.push(feed_.set(1, {"south"}));
    session.wait_for_rigs(300ms, stop_);
    EXPECT_EQ(session.shown()->present(), 1);
}

TEST_F(LiveSessionTest, SaysWhichRigsHaveNotCome) {
    LiveSession session = this->session();
    const std::string sentence = thrown_sentence([&] { session.wait_for_rigs(100ms, stop_); });
    EXPECT_NE(sentence.find("north connected; south connected"), std::string::npos) << sentence;
}

TEST_F(LiveSessionTest, SaysWhatItWaitedForWhenItIsInterrupted) {
    LiveSession session = this->session();
    kill(getpid(), SIGTERM);
    const std::string sentence = thrown_sentence([&] { session.wait_for_rigs(1h, stop_); });
    EXPECT_NE(sentence.find("interrupted"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("north connected; south connected"), std::string::npos) << sentence;
}

TEST_F(LiveSessionTest, GivesUpAtOnceWhenEveryRigRefuses) {
    feed_.set_refused("the key is not in its authorized_hosts");
    LiveSession session = this->session();
    const std::string sentence = thrown_sentence([&] { session.wait_for_rigs(1h, stop_); });
    EXPECT_NE(sentence.find("authorized_hosts"), std::string::npos) << sentence;
}

TEST_F(LiveSessionTest, RefusesAnUnknownSynthesiserByName) {
    settings_.synthesiser = "hologram";
    const std::string sentence = thrown_sentence([&] { session(); });
    EXPECT_NE(sentence.find("hologram"), std::string::npos);
    EXPECT_NE(sentence.find("mesh"), std::string::npos);
}

TEST_F(LiveSessionTest, KeepsBooksThatAddUp) {
    LiveSession session = this->session();
    for (std::uint64_t k = 0; k < 12; ++k)
        feed_.push(feed_.set(k, k % 3 ? std::vector<std::string>{"north", "south"}
                                      : std::vector<std::string>{"north"}));
    session.wait_for_rigs(10s, stop_);
    for (int i = 0; !session.shown() || session.shown()->trigger_index < 11; ++i) {
        ASSERT_LT(i, 1000);
        session.make_picture(view_, i * 1ms);
    }
    session.make_picture(view_, 2s);
    session.finish();
    const LiveReport report = session.report();
    EXPECT_EQ(report.sets_closed, 12u);
    EXPECT_EQ(report.sets_complete, 8u);
    EXPECT_EQ(report.sets_fused + report.sets_superseded, 12u);
    ASSERT_EQ(report.rigs.size(), 2u);
    EXPECT_EQ(report.rigs[0].fused + report.rigs[0].superseded, 12u);
    EXPECT_EQ(report.rigs[1].fused + report.rigs[1].superseded, 8u);
    EXPECT_GE(report.latency_ms.count, 1u);
    EXPECT_EQ(report.stages[2].stage, "match");
    EXPECT_EQ(report.stages[2].ms.p50, 3);

    const nlohmann::ordered_json json = to_json(report);
    EXPECT_EQ(json["sets"]["partial"], 4);
    EXPECT_EQ(json["rigs"][0]["name"], "north");
    EXPECT_EQ(json["rigs"][0]["host"]["fused"], report.rigs[0].fused);
    EXPECT_NEAR(json["rigs"][0]["colour"]["gains"][1], 1, 0.01) << "both show one colour";
    EXPECT_TRUE(json["rigs"][0]["colour"].contains("shared_points"));
    EXPECT_EQ(json["stages_ms"]["match"]["p95"], 3);
    EXPECT_FALSE(json["stages_ms"].contains("encode")) << "no film was written";
    const std::string text = to_text(report);
    EXPECT_NE(text.find("12 frame sets, 8 complete and 4 partial"), std::string::npos) << text;
    EXPECT_NE(text.find("superseded"), std::string::npos);
}

TEST_F(LiveSessionTest, WritesFilmAndContactSheetOfAFlight) {
    settings_.film = folder_.path() / "flight.mkv";
    settings_.contact_sheet = folder_.path() / "sheet.png";
    LiveSession session = this->session();
    feed_.push(feed_.set(1, {"north", "south"}));
    session.wait_for_rigs(10s, stop_);
    const FlightPlan plan{.start = view_, .move = {}, .frames = 12, .seconds = {}};
    fly_headless(session, plan, nullptr, settings_.rate_hz, stop_);
    session.finish();
    const LiveReport report = session.report();
    EXPECT_EQ(report.pictures, 12u);
    EXPECT_EQ(report.film_pictures + report.film_dropped, 12u);
    EXPECT_TRUE(std::filesystem::exists(settings_.film));
    // Title, five moments of three stills each.
    const ColourImage sheet = read_colour_image(settings_.contact_sheet);
    EXPECT_GT(sheet.cols, 3 * 480);
    EXPECT_GT(sheet.rows, 5 * 360);
}

TEST_F(LiveSessionTest, EndsWithAMoveThatDoesNotLoop) {
    LiveSession session = this->session();
    feed_.push(feed_.set(1, {"north", "south"}));
    session.wait_for_rigs(10s, stop_);
    OrbitView end = view_;
    end.azimuth_rad = 0.3;
    const Move move({{0, view_, Easing::linear}, {0.2, end, Easing::linear}}, false);
    const std::uint64_t skipped = fly_headless(
        session, {.start = view_, .move = move, .frames = {}, .seconds = {}}, nullptr, 50, stop_);
    session.finish();
    const std::uint64_t pictures = session.report().pictures;
    EXPECT_LE(pictures, 11u) << "ticks 0 to 10 of 20 ms, both included";
    EXPECT_GE(pictures + skipped, 11u);
}

TEST_F(LiveSessionTest, EndsAfterTheSecondsOfThePlan) {
    LiveSession session = this->session();
    feed_.push(feed_.set(1, {"north", "south"}));
    session.wait_for_rigs(10s, stop_);
    const FlightPlan plan{.start = view_, .move = {}, .frames = {}, .seconds = 0.1};
    const std::uint64_t skipped = fly_headless(session, plan, nullptr, 50, stop_);
    session.finish();
    const std::uint64_t pictures = session.report().pictures;
    EXPECT_GE(pictures, 1u);
    EXPECT_LE(pictures, 5u) << "ticks 0 to 4 of 20 ms";
    EXPECT_GE(pictures + skipped, 5u);
}

TEST_F(LiveSessionTest, StopsWhenAsked) {
    LiveSession session = this->session();
    feed_.push(feed_.set(1, {"north", "south"}));
    session.wait_for_rigs(10s, stop_);
    kill(getpid(), SIGTERM);
    fly_headless(session, {.start = view_, .move = {}, .frames = {}, .seconds = {}}, nullptr, 50,
                 stop_);
    session.finish();
    EXPECT_LE(session.report().pictures, 1u);
}

}  // namespace
}  // namespace vantage

#include "host_app/session/live_show.h"

#include <cmath>
#include <csignal>
#include <memory>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/image/image_file.h"
#include "host_app/session/report/show_log.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/frames/scripted_feed.h"
#include "tests/unit/host_app/output/probed_film.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

class LiveShowTest : public testing::Test {
  protected:
    LiveShowTest() {
        // At the rigs' position, from which all of the wall is covered.
        plan_.start = OrbitView{.distance_m = 4.5, .field_of_view_rad = 1.0};
    }
    LiveShow& show() {
        if (!show_) show_ = std::make_unique<LiveShow>(settings_, plan_, feed_.feed(), nullptr);
        return *show_;
    }
    std::string refusal() {
        return thrown_sentence([&] { show(); });
    }
    void push(std::uint64_t pulse, unsigned char red = 200) {
        feed_.push(feed_.set(pulse, {"north", "south"}, {red, 100, 50, 255}));
    }
    template <class Condition>
    static bool wait_for(Condition condition) {
        for (int i = 0; i < 15000; ++i) {
            if (condition()) return true;
            std::this_thread::sleep_for(2ms);
        }
        return false;
    }
    /// Runs the show from the first frame set to the end of the plan.
    LiveReport fly() {
        push(1);
        EXPECT_TRUE(show().wait_for_rigs(30s, stop_));
        show().start();
        EXPECT_TRUE(wait_for([&] { return show().is_over(); }));
        show().finish();
        return show().report();
    }

    StopSignal stop_;
    TemporaryFolder folder_;
    ScriptedFeed feed_{{"north", "south"}};
    FlightPlan plan_;
    LiveSettings settings_{.format = {.width_px = 64, .height_px = 48},
                           .rate_hz = 25,
                           .pulse_rate_hz = 25,
                           .synthesiser = "mesh",
                           .quality = {},
                           .contact_sheet = {}};
    std::unique_ptr<LiveShow> show_;
};

TEST_F(LiveShowTest, WaitsForAllRigs) {
    feed_.push(feed_.set(1, {"south"}));
    std::thread later([&] {
        std::this_thread::sleep_for(300ms);
        push(2);
    });
    EXPECT_TRUE(show().wait_for_rigs(1h, stop_));
    later.join();
    EXPECT_EQ(show().newest()->set->present(), 2);
}

TEST_F(LiveShowTest, ContinuesWithTheRigsThatSendFrames) {
    feed_.push(feed_.set(1, {"south"}));
    ASSERT_TRUE(wait_for([&] { return show().newest() != nullptr; }));
    EXPECT_TRUE(show().wait_for_rigs(200ms, stop_));
    EXPECT_EQ(show().newest()->set->present(), 1);
}

TEST_F(LiveShowTest, NamesTheRigsThatSendNoFrames) {
    const std::string sentence = thrown_sentence([&] { show().wait_for_rigs(100ms, stop_); });
    EXPECT_NE(sentence.find("within 0.1 s"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("north connected; south connected"), std::string::npos) << sentence;
}

TEST_F(LiveShowTest, WaitsOnForRigsThatReportThatTheyStart) {
    constexpr auto limit = 50ms;
    feed_.set_starting("compiling shader 3 of 9");
    show();
    const MonotonicTime begin = MonotonicClock::now();
    bool is_pushed = false;
    testing::internal::CaptureStderr();
    EXPECT_TRUE(show().wait_for_rigs(limit, stop_, [&] {
        if (is_pushed || MonotonicClock::now() - begin < 3 * limit) return;
        is_pushed = true;
        push(1);
    }));
    const std::string log = testing::internal::GetCapturedStderr();
    EXPECT_NE(log.find("waiting on, up to 300.05 s, because rigs are starting: "
                       "north: compiling shader 3 of 9; south: compiling"),
              std::string::npos)
        << log;
    EXPECT_EQ(show().newest()->set->present(), 2);
}

TEST_F(LiveShowTest, GivesUpRigsThatStartForTooLong) {
    feed_.set_starting("compiling shader 3 of 9");
    const std::string sentence =
        thrown_sentence([&] { show().wait_for_rigs(50ms, stop_, {}, 150ms); });
    EXPECT_NE(sentence.find("no rig sent a frame within 0.2 s"), std::string::npos) << sentence;
}

TEST_F(LiveShowTest, EndsTheWaitOnASignalAndNamesTheMissingRigs) {
    show();
    kill(getpid(), SIGINT);
    testing::internal::CaptureStderr();
    EXPECT_FALSE(show().wait_for_rigs(1h, stop_));
    const std::string log = testing::internal::GetCapturedStderr();
    EXPECT_NE(log.find("interrupted"), std::string::npos) << log;
    EXPECT_NE(log.find("north connected; south connected"), std::string::npos) << log;
}

TEST_F(LiveShowTest, GivesUpAtOnceWhenEveryRigRefuses) {
    feed_.set_refused("the key is not in its authorized_hosts");
    const std::string sentence = thrown_sentence([&] { show().wait_for_rigs(1h, stop_); });
    EXPECT_NE(sentence.find("authorized_hosts"), std::string::npos) << sentence;
}

TEST_F(LiveShowTest, RefusesAnUnknownSynthesiserByName) {
    settings_.synthesiser = "hologram";
    EXPECT_NE(refusal().find("hologram"), std::string::npos);
    EXPECT_NE(refusal().find("mesh"), std::string::npos);
}

TEST_F(LiveShowTest, RefusesASourceMapOfASynthesiserWithoutOne) {
    settings_.source_map = true;
    settings_.synthesiser = "points";
    EXPECT_NE(refusal().find("'points' does not report"), std::string::npos) << refusal();
}

TEST_F(LiveShowTest, RefusesAStereoscopicPictureOfAnOddWidth) {
    settings_.format.stereoscopy = Stereoscopy{};
    settings_.format.width_px = 65;
    EXPECT_NE(refusal().find("65 px is not, take 64 or 66"), std::string::npos) << refusal();
}

TEST_F(LiveShowTest, RefusesAFilmThatCannotBeWritten) {
    settings_.outputs = {folder_.path() / "no" / "film.mkv"};
    EXPECT_NE(refusal().find(settings_.outputs[0]), std::string::npos) << refusal();
}

TEST_F(LiveShowTest, AccountsForEveryFrame) {
    for (std::uint64_t k = 0; k < 12; ++k)
        feed_.push(feed_.set(k, k % 3 ? std::vector<std::string>{"north", "south"}
                                      : std::vector<std::string>{"north"}));
    ASSERT_TRUE(show().wait_for_rigs(30s, stop_));
    show().start();
    ASSERT_TRUE(wait_for([&] {
        const auto picture = show().state().picture;
        return picture && picture->job.instant->set->trigger_index == 11;
    }));
    // The last frame sets may not be taken any more.
    push(12);
    push(13);
    show().finish();
    const LiveReport report = show().report();
    EXPECT_EQ(report.frame_sets_closed, 14u);
    EXPECT_EQ(report.frame_sets_complete, 10u);
    EXPECT_EQ(report.instants_prepared + report.frame_sets_replaced, 14u);
    ASSERT_EQ(report.rigs.size(), 2u);
    EXPECT_EQ(report.rigs[0].fused + report.rigs[0].replaced, 14u);
    EXPECT_EQ(report.rigs[1].fused + report.rigs[1].replaced, 10u);
    EXPECT_GE(report.programme.latency_ms.count, 1u);
    EXPECT_EQ(report.rig_steps.match_ms.p50, 3);

    const nlohmann::ordered_json json = to_json(report);
    EXPECT_EQ(json["frame_sets"]["partial"], 4);
    EXPECT_EQ(json["frame_sets"]["fused"], report.instants_prepared);
    EXPECT_EQ(json["instants"]["skipped"], report.frame_sets_replaced);
    EXPECT_EQ(json["rigs"][0]["name"], "north");
    EXPECT_EQ(json["rigs"][0]["host"]["fused"], report.rigs[0].fused);
    EXPECT_NEAR(json["rigs"][0]["colour"]["gains"][1], 1, 0.01) << "both show one colour";
    EXPECT_TRUE(json["rigs"][0]["colour"].contains("shared_points"));
    EXPECT_EQ(json["stages_ms"]["match"]["p95"], 3);
    EXPECT_TRUE(json["stages_ms"].contains("render"));
    EXPECT_FALSE(json["stages_ms"].contains("encode")) << "no film was written";
    EXPECT_EQ(json["faults"], 0);
    const std::string text = to_text(report);
    EXPECT_NE(text.find("14 frame sets, 10 complete and 4 partial"), std::string::npos) << text;
    EXPECT_NE(text.find("replaced by newer"), std::string::npos);
}

TEST_F(LiveShowTest, CountsAnInstantOnceThoughItIsReplayed) {
    settings_.replay_bytes = 100'000'000;
    show().start();
    const auto shows = [&](std::uint64_t pulse) {
        return wait_for([&] {
            const auto picture = show().state().picture;
            return picture && picture->job.instant->set->trigger_index == pulse;
        });
    };
    for (std::uint64_t pulse = 1; pulse <= 4; ++pulse) {
        push(pulse);
        ASSERT_TRUE(shows(pulse));
    }
    for (const double steps : {-2, +1, -2}) {
        const std::uint64_t before = show().state().picture->job.instant->set->trigger_index;
        show().controls().operator_input().put({.commands = {command::StepFrames{steps}}},
                                               MonotonicClock::now());
        ASSERT_TRUE(shows(before + static_cast<std::uint64_t>(static_cast<std::int64_t>(steps))));
    }
    show().finish();
    const LiveReport report = show().report();
    EXPECT_EQ(report.instants_prepared, 4u);
    EXPECT_EQ(report.frame_sets_closed, 4u);
    EXPECT_EQ(report.rigs[0].fused, 4u);
}

TEST_F(LiveShowTest, WritesFilmAndContactSheetOfAFlight) {
    settings_.outputs = {folder_.path() / "flight.mkv"};
    settings_.contact_sheet = folder_.path() / "sheet.png";
    OrbitView end = *plan_.start;
    end.azimuth_rad = 0.1;
    plan_.move = Move({{0, *plan_.start, Easing::linear}, {10, end, Easing::linear}}, false);
    plan_.frames = 12;
    const LiveReport report = fly();
    EXPECT_GE(report.programme.ticks, 12u);
    ASSERT_EQ(report.outputs.size(), 1u);
    const OutputState& written = report.outputs[0];
    EXPECT_GE(written.pictures, 8u);
    EXPECT_EQ(written.pictures + written.dropped, report.programme.ticks);
    EXPECT_EQ(written.failure, "");
    for (const SinkState& sink : report.programme.sinks) EXPECT_EQ(sink.failure, "") << sink.name;
    const ProbedFilm film = probe_film(settings_.outputs[0]);
    ASSERT_EQ(film.times_s.size(), written.pictures);
    for (std::size_t i = 0; i < film.times_s.size(); ++i) {
        const double ticks = film.times_s[i] * settings_.rate_hz;
        EXPECT_NEAR(ticks, std::round(ticks), 0.03) << "a constant rate";
        if (written.dropped == 0) {
            EXPECT_NEAR(ticks, static_cast<double>(i), 0.03);
        }
        EXPECT_GT(film.middle_lumas[i], 60) << "black at " << film.times_s[i] << " s";
    }
    // A title and five instants with three stills each.
    const ColourImage sheet = read_colour_image(settings_.contact_sheet);
    EXPECT_GT(sheet.cols, 3 * 480);
    EXPECT_GT(sheet.rows, 5 * 360);
    const nlohmann::ordered_json json = to_json(report);
    EXPECT_EQ(json["outputs"].size(), 2u);
    EXPECT_TRUE(json["stages_ms"].contains("encode"));
}

TEST_F(LiveShowTest, AFilmStartsWithTheFirstPicture) {
    settings_.outputs = {folder_.path() / "flight.mkv"};
    show().start();
    std::this_thread::sleep_for(400ms);
    push(1);
    ASSERT_TRUE(wait_for([&] { return show().stats().ticks > 5; }));
    show().finish();
    const ProbedFilm film = probe_film(settings_.outputs[0]);
    ASSERT_FALSE(film.times_s.empty());
    EXPECT_EQ(film.times_s.front(), 0);
    EXPECT_GT(film.middle_lumas.front(), 60);
}

TEST_F(LiveShowTest, ReportsAFilmWithoutAPictureAsFailed) {
    settings_.outputs = {folder_.path() / "flight.mkv"};
    show().start();
    show().finish();
    const LiveReport report = show().report();
    EXPECT_EQ(report.programme.pictures, 0u);
    EXPECT_NE(report.outputs.at(0).failure.find("has no picture"), std::string::npos)
        << report.outputs.at(0).failure;
    EXPECT_FALSE(std::filesystem::exists(settings_.outputs[0]));
}

TEST_F(LiveShowTest, ReportsTheSourceMapAndTheEyesOfTheLastPicture) {
    settings_.source_map = true;
    settings_.format.stereoscopy = Stereoscopy{};
    plan_.frames = 1;
    const LiveReport report = fly();
    ASSERT_TRUE(report.source_map);
    EXPECT_EQ(report.source_map->rigs.size(), 2u);
    EXPECT_NEAR(report.source_map->rigs.at("north") + report.source_map->rigs.at("south") +
                    report.source_map->filled,
                1, 1e-6);
    const nlohmann::ordered_json json = to_json(report);
    EXPECT_EQ(json["stereoscopic"]["convergence_m"], 4.5);
    EXPECT_GT(json["stereoscopic"]["interaxial_m"], 0.05);
    EXPECT_TRUE(json.contains("source_map"));
}

TEST_F(LiveShowTest, ReportsNoSourceMapThatWasNotShown) {
    plan_.frames = 1;
    EXPECT_FALSE(to_json(fly()).contains("source_map"));
}

TEST_F(LiveShowTest, EndsAfterTheSecondsOfThePlan) {
    plan_.seconds = 1;
    const LiveReport report = fly();
    EXPECT_GE(report.programme.ticks, 5u);
    EXPECT_LE(report.programme.ticks, 26u) << "of 40 ms";
}

TEST_F(LiveShowTest, ComputesTheCorridorOfThePresentRigs) {
    plan_.frames = 3;
    const LiveReport report = fly();
    ASSERT_TRUE(show().corridor());
    const nlohmann::ordered_json json = to_json(report);
    EXPECT_EQ(json["corridor"]["place"], "inside");
    EXPECT_GT(json["corridor"]["coverage"], 0.9);
    EXPECT_EQ(json["corridor"]["beyond_s"], 0);
    EXPECT_NE(to_text(report).find("the rigs cover "), std::string::npos);
}

TEST_F(LiveShowTest, WarnsWhereAPlannedMoveLeavesTheCorridorAndFliesIt) {
    // The rigs' position again, with the pivot on the wall.
    plan_.start = OrbitView{.pivot_m = {0, 1, 2.5}, .distance_m = 2, .field_of_view_rad = 1.0};
    OrbitView aside = *plan_.start;
    aside.azimuth_rad = 1.9;
    plan_.move = Move({{0, *plan_.start, Easing::linear}, {1, aside, Easing::linear}}, false);
    plan_.seconds = 2;
    push(1);
    ASSERT_TRUE(show().wait_for_rigs(30s, stop_));
    show().start();
    CorridorWatch watch(plan_);
    testing::internal::CaptureStderr();
    EXPECT_TRUE(wait_for([&] {
        watch.tell(show());
        return show().is_over();
    }));
    show().finish();
    const std::string log = testing::internal::GetCapturedStderr();
    EXPECT_NE(log.find("the planned move leaves the area the rigs cover from 0."),
              std::string::npos)
        << log;
    EXPECT_NE(log.find("the camera is outside the area the rigs cover"), std::string::npos) << log;
    EXPECT_EQ(log.find("the camera is outside"), log.rfind("the camera is outside")) << "once";
    LiveReport report = show().report();
    report.uncovered = watch.uncovered_parts();
    EXPECT_NEAR(report.view.azimuth_rad, 1.9, 1e-6);
    const nlohmann::ordered_json json = to_json(report);
    EXPECT_EQ(json["corridor"]["place"], "beyond");
    EXPECT_GT(json["corridor"]["beyond_s"], 0.2);
    EXPECT_EQ(json["corridor"]["move_beyond"].at(0)["loss"], "aside");
}

TEST_F(LiveShowTest, RethrowsAnErrorOfTheFeed) {
    feed_.fail_with("the receiver broke");
    EXPECT_EQ(thrown_sentence([&] { show().wait_for_rigs(1h, stop_); }), "the receiver broke");
}

}  // namespace
}  // namespace vantage

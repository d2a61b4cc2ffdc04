#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "host_app/flight/flight_plan.h"
#include "tests/processes/live/steered_show.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/source_folder.h"

namespace vantage {
namespace {

/// Plays a take, steers it with oscsend and reads its lamps with oscdump, each in its own process.
TEST(Control, SteersAShowAndReportsItsLamps) {
    const TemporaryFolder folder;
    SteeredShow steered({"play", (source_folder() / "tests/takes/version_1.mkv").string(),
                         "--headless", "--size", "96x72", "--loop", "--seconds", "300", "--json"},
                        folder);
    ASSERT_TRUE(steered.is_told("lamp/speed f 1.0")) << steered.told() << steered.show().err();
    ASSERT_TRUE(steered.send("/vantage/mark_in"));
    EXPECT_TRUE(steered.is_told("lamp/mark_in i 1")) << steered.told();
    ASSERT_TRUE(steered.send("/vantage/freeze"));
    EXPECT_TRUE(steered.is_told("lamp/hold i 1")) << steered.told();
    ASSERT_TRUE(steered.send("/vantage/no_such"));
    ASSERT_TRUE(steered.send("/vantage/orbit f 10.0"));
    ASSERT_TRUE(steered.send("/vantage/source_map"));
    EXPECT_TRUE(steered.is_told("lamp/source_map i 1")) << steered.told();
    steered.show().send_signal(SIGINT);
    const ProgramResult end = steered.show().wait();
    const nlohmann::json summary = nlohmann::json::parse(end.out);
    ASSERT_EQ(summary["control"].size(), 1u);
    EXPECT_EQ(summary["control"][0]["obeyed"], 4);
    EXPECT_EQ(summary["control"][0]["unknown"], 1);
    EXPECT_TRUE(summary["time"]["in"].is_number()) << summary["time"];
}

/// Without a sequencer the show fails before it starts and names the remedy.
TEST(Control, ByMidiIsRefusedWithoutASequencer) {
    if (access("/dev/snd/seq", F_OK) == 0) GTEST_SKIP() << "SKIPPED: this computer has one";
    const ProgramResult end =
        run_to_end(VANTAGE_PROGRAM,
                   {"play", (source_folder() / "tests/takes/version_1.mkv").string(), "--headless",
                    "--size", "96x72", "--seconds", "1", "--control", "midi://all"});
    EXPECT_EQ(end.status, 1) << end.err;
    EXPECT_NE(end.err.find("modprobe snd-seq"), std::string::npos) << end.err;
}

/// A flight over a take is recorded to a flight file, played and rendered to a film.
TEST(Flight, OverATakeIsRecordedPlayedAndFilmed) {
    const TemporaryFolder folder;
    const std::string take = (folder.path() / "take.mkv").string();
    const std::string flight = (folder.path() / "take.flight.toml").string();
    const std::string film = (folder.path() / "film.mkv").string();
    std::filesystem::copy_file(source_folder() / "tests/takes/version_1.mkv", take);
    SteeredShow steered(
        {"play", take, "--headless", "--size", "96x72", "--loop", "--seconds", "300"}, folder);
    ASSERT_TRUE(steered.is_told("lamp/speed f 1.0")) << steered.told() << steered.show().err();
    ASSERT_TRUE(steered.send("/vantage/store i 4"));
    ASSERT_TRUE(steered.send("/vantage/record"));
    ASSERT_TRUE(steered.is_told("lamp/record i 1")) << steered.told();
    ASSERT_TRUE(steered.send("/vantage/orbit f 12.0"));
    ASSERT_TRUE(steered.send("/vantage/source_map"));
    ASSERT_TRUE(steered.is_told("lamp/source_map i 1")) << "the turn was executed before";
    ASSERT_TRUE(steered.send("/vantage/record"));
    steered.show().wait_for("became a move of");
    steered.show().wait_for(" frames, ");
    steered.show().send_signal(SIGINT);
    EXPECT_EQ(steered.show().wait().status, 130) << steered.show().err();
    EXPECT_EQ(steered.show().err().find("exposure"), std::string::npos)
        << "a take has no latency: " << steered.show().err();
    const FlightBook book = load_flight(flight);
    ASSERT_TRUE(book.move);
    EXPECT_TRUE(book.move->take_s_at(0));
    EXPECT_TRUE(book.shots[3]);
    const double turned_rad =
        book.move->at(book.move->duration_s()).azimuth_rad - book.move->at(0).azimuth_rad;
    EXPECT_GT(turned_rad, 0.02) << "of 0.2 rad";
    const ProgramResult played = run_to_end(VANTAGE_PROGRAM, {"play", take, "--headless", "--size",
                                                              "96x72", "--path", flight, "--json"});
    EXPECT_EQ(played.status, 0) << played.err;
    const ProgramResult filmed =
        run_to_end(VANTAGE_PROGRAM, {"take", "export", take, "--as", "film", "--path", flight,
                                     "--size", "96x72", "--rate", "10", "-o", film, "--json"});
    EXPECT_EQ(filmed.status, 0) << filmed.err;
    EXPECT_EQ(nlohmann::json::parse(filmed.out)["written"],
              std::max(1L, std::lround(10 * book.move->duration_s())));
    EXPECT_NE(run_to_end(VANTAGE_PROGRAM,
                         {"take", "export", take, "--as", "film", "--path", flight, "-o", film})
                  .err.find("already"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage

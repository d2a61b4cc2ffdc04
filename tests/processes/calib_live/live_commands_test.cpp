#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/board/board_file.h"
#include "common/colour/colour_file.h"
#include "common/config/calibration_file.h"
#include "common/image/image_file.h"
#include "common/virtual_stage/virtual_rig.h"
#include "tests/support/boards/rendered_stage.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/free_ports.h"

namespace vantage {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Two running rigs, each a process of its own, and vantage-calib as a third, over links that are
/// encrypted and authenticated both ways.
class LiveCalibration : public testing::Test {
  protected:
    LiveCalibration() {
        std::ofstream(file("hosts.keys")) << new_key("host") << '\n';
        std::ofstream stage(file("stage.toml"));
        stage << "version = 1\nrate_hz = 4\nkey_file = \"host.key\"\n";
        for (const char* name : {"A", "B"})
            stage << "[[rigs]]\nname = \"" << name << "\"\nendpoint = \"" << endpoint(name)
                  << "\"\npublic_key = \"" << new_key(name) << "\"\n";
    }

    /// Its public half, as a line of text.
    std::string new_key(const std::string& name) const {
        const ProgramResult made =
            run_to_end(VANTAGE_RIG_PROGRAM, {"keys", "new", file(name + ".key"), "--json"});
        return nlohmann::json::parse(made.out).at("public_key");
    }

    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
    std::string endpoint(const std::string& rig) const {
        return fmt::format("tcp://127.0.0.1:{}", rig == "A" ? ports_.first : ports_.second);
    }

    void start_rig(const std::string& name, const std::string& more_top,
                   const std::string& source) {
        const std::string config = file(name + ".toml");
        std::ofstream(config) << "version = 1\nname = \"" << name << "\"\n"
                              << more_top << "[source]\nrate_hz = 4\n"
                              << source << "[stream]\nbind = \"" << endpoint(name)
                              << "\"\nkey_file = \"" << name
                              << ".key\"\nauthorized_hosts = \"hosts.keys\"\n";
        rigs_.push_back(std::make_unique<ChildProgram>(
            VANTAGE_RIG_PROGRAM, std::vector<std::string>{"run", "--config", config},
            folder_.path()));
    }

    /// A rig without calibration that sees the pictures of a folder over and over, a new one every
    /// pulse.
    void start_filming_rig(const std::string& name) {
        start_rig(name, "calibration = \"none\"\n",
                  "kind = \"files\"\nleft = \"" + file(name + "/film/left%d.png") +
                      "\"\nright = \"" + file(name + "/film/right%d.png") + "\"\n");
    }

    void write_film(const std::string& rig, int number, const GreyImage& left,
                    const GreyImage& right) const {
        std::filesystem::create_directories(file(rig + "/film"));
        write_grey_image(file(fmt::format("{}/film/left{}.png", rig, number)), left);
        write_grey_image(file(fmt::format("{}/film/right{}.png", rig, number)), right);
    }

    std::vector<std::string> live(std::vector<std::string> arguments) const {
        for (const char* more : {"--live", "", "--json"})
            arguments.emplace_back(*more ? more : file("stage.toml"));
        return arguments;
    }
    ProgramResult calibrate(const std::vector<std::string>& arguments) const {
        return run_to_end(VANTAGE_CALIB, live(arguments));
    }

    TemporaryFolder folder_;
    std::pair<int, int> ports_ = two_free_ports();
    std::vector<std::unique_ptr<ChildProgram>> rigs_;
};

const std::vector<std::string> board = {"--board", "9x6", "--square-m", "0.1"};

std::vector<std::string> with_board(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), board.begin(), board.end());
    return arguments;
}

TEST_F(LiveCalibration,
       makes_the_first_calibration_of_a_rig_while_it_films_and_says_what_is_missing) {
    RenderedStage stage(chessboard_pattern("9x6", 0.1), 480, 3);
    // An odd count: every second pulse is asked for, and all pictures come.
    constexpr int pictures = 21;
    for (int i = 0; i < pictures; ++i) {
        const Pose world_from_board = stage.world_from_board_near(0);
        PictureFaults faults;
        if (i % 6 == 1) faults.blur_px = 2.2;
        if (i % 6 == 4) faults.glare = 0.5;
        write_film("A", i, stage.film(0, 0, world_from_board, faults),
                   stage.film(0, 1, world_from_board, faults));
    }
    start_filming_rig("A");
    const ProgramResult result =
        calibrate(with_board({"stereo", "--rig", "A=" + file("A/kept"), "-o",
                              file("A/calibration.yaml"), "--lens", "brown4", "--views", "12"}));
    ASSERT_EQ(result.status, 0) << result.err << rigs_[0]->err();
    const StereoCalibration& truth = stage.truth(0);
    const StereoCalibration solved = load_calibration(file("A/calibration.yaml"));
    EXPECT_NEAR(solved.left.fx_px, truth.left.fx_px, 2e-3 * truth.left.fx_px);
    EXPECT_NEAR(solved.right_from_left.translation().norm(),
                truth.right_from_left.translation().norm(), 1e-3);
    EXPECT_THAT(result.err, HasSubstr("still missing: "));
    EXPECT_THAT(result.err, HasSubstr("1 kept of 12"));
    EXPECT_THAT(result.err, HasSubstr("png is blurred: edges of"));
    EXPECT_THAT(result.err, HasSubstr("overexposed (glare)"));
    const auto json = nlohmann::json::parse(result.out);
    const auto views = json.at("views_given").get<int>();
    EXPECT_LE(views, 12);
    int kept = 0;
    for (const auto& entry : std::filesystem::directory_iterator(file("A/kept")))
        kept += entry.path().filename().string().starts_with("left_") ? 1 : 0;
    EXPECT_EQ(kept, views);

    // A folder that holds a film is not mixed with another one.
    const ProgramResult again = calibrate(
        with_board({"intrinsics", "--rig", "A=" + file("A/kept"), "-o", file("camera.yaml")}));
    EXPECT_EQ(again.status, 1);
    EXPECT_THAT(again.err, HasSubstr("holds left pictures already: go on filming from them"));
}

TEST_F(LiveCalibration, loses_nothing_when_it_is_interrupted_and_goes_on_from_what_it_kept) {
    RenderedStage stage(chessboard_pattern("9x6", 0.1), 480, 3);
    std::vector<Pose> places;
    for (int i = 0; i < 15; ++i) places.push_back(stage.world_from_board_near(0));
    const auto film = [&](int number, const Pose& world_from_board) {
        write_film("A", number, stage.film(0, 0, world_from_board, {}),
                   stage.film(0, 1, world_from_board, {}));
    };
    // Two places, from which no camera can be calibrated however late the interrupt comes; in three
    // pictures, since only every second pulse is asked for.
    for (const int i : {0, 1, 2}) film(i, places[static_cast<std::size_t>(i % 2)]);
    start_filming_rig("A");
    const auto asking_for = [&](const char* views) {
        return with_board({"stereo", "--rig", "A=" + file("A/kept"), "-o",
                           file("A/calibration.yaml"), "--lens", "brown4", "--views", views});
    };
    ChildProgram interrupted(VANTAGE_CALIB, live(asking_for("30")), folder_.path());
    interrupted.wait_for("2 kept");
    interrupted.send_signal(SIGINT);
    const ProgramResult ended = interrupted.wait();
    EXPECT_EQ(ended.status, 130);
    EXPECT_THAT(ended.err, HasSubstr("the film was ended; "));
    EXPECT_THAT(ended.err,
                HasSubstr("kept in " + file("A/kept") +
                          ": the same command with --go-on films more, and without --live"));
    EXPECT_FALSE(std::filesystem::exists(file("A/calibration.yaml")));
    int kept = 0;
    for (const auto& entry : std::filesystem::directory_iterator(file("A/kept")))
        kept += entry.path().filename().string().starts_with("left_") ? 1 : 0;
    ASSERT_EQ(kept, 2);

    // What the sentence says holds: without --live the kept pictures are looked at.
    const ProgramResult without =
        run_to_end(VANTAGE_CALIB, with_board({"stereo", "--rig", "A=" + file("A/kept"), "-o",
                                              file("A/calibration.yaml"), "--lens", "brown4"}));
    EXPECT_THAT(without.err, HasSubstr(fmt::format("{0} of {0} pictures searched", 2 * kept)));

    rigs_.clear();
    for (int i = 0; const Pose& place : places) film(i++, place);
    start_filming_rig("A");
    std::vector<std::string> going_on = asking_for("9");
    going_on.emplace_back("--go-on");
    const ProgramResult result = calibrate(going_on);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr(fmt::format("{} kept from before", kept)));
    EXPECT_THAT(result.err, HasSubstr(fmt::format("{} kept of 9 (pulse", kept + 1)));
    EXPECT_NEAR(load_calibration(file("A/calibration.yaml")).left.fx_px, stage.truth(0).left.fx_px,
                3e-3 * stage.truth(0).left.fx_px);
}

TEST_F(LiveCalibration, calibrates_one_camera_of_a_running_rig) {
    RenderedStage stage(chessboard_pattern("9x6", 0.1), 480, 6);
    for (int i = 0; i < 9; ++i) {
        const Pose world_from_board = stage.world_from_board_near(0);
        write_film("A", i, stage.film(0, 0, world_from_board, {}),
                   stage.film(0, 1, world_from_board, {}));
    }
    start_filming_rig("A");
    const ProgramResult result =
        calibrate(with_board({"intrinsics", "--rig", "A=" + file("kept"), "--side", "right", "-o",
                              file("camera.yaml"), "--lens", "brown4", "--views", "8"}));
    ASSERT_EQ(result.status, 0) << result.err << rigs_[0]->err();
    const auto json = nlohmann::json::parse(result.out);
    const double truth = stage.truth(0).right.fx_px;
    EXPECT_NEAR(json.at("camera").at("fx").get<double>(), truth, 5e-3 * truth);
    EXPECT_FALSE(std::filesystem::exists(file("camera.yaml.last")));
}

TEST_F(LiveCalibration, places_two_rigs_by_what_both_see_at_the_same_pulse) {
    RenderedStage stage(chessboard_pattern("9x6", 0.1), 640, 9);
    constexpr int first_rig = 1;
    const char* names[] = {"A", "B"};
    for (int r = 0; r < 2; ++r) {
        StereoCalibration known = stage.truth(first_rig + r);
        known.world_from_left = Pose::Identity();
        compute_rectification(known, 0);
        std::filesystem::create_directories(file(names[r]));
        save_calibration(file(std::string(names[r]) + "/calibration.yaml"), known,
                         {"2026-01-01T00:00:00Z", "test", 0.02, 0.02, 12});
    }
    for (int i = 0; i < 7; ++i) {
        const Pose world_from_board = stage.board_before_pair(first_rig);
        for (int r = 0; r < 2; ++r)
            write_film(names[r], i, stage.film(first_rig + r, 0, world_from_board, {}),
                       stage.film(first_rig + r, 1, world_from_board, {}));
    }
    for (const char* name : names) start_filming_rig(name);
    const ProgramResult result = calibrate(with_board(
        {"stage", "--rig", "A=" + file("A"), "--rig", "B=" + file("B"), "-o", file("world")}));
    ASSERT_EQ(result.status, 0) << result.err << rigs_[0]->err() << rigs_[1]->err();
    const Pose found = load_calibration(file("world/A.yaml")).world_from_left.inverse() *
                       load_calibration(file("world/B.yaml")).world_from_left;
    const Pose truth = stage.truth(first_rig).world_from_left.inverse() *
                       stage.truth(first_rig + 1).world_from_left;
    EXPECT_LT((found.translation() - truth.translation()).norm(), 0.005);
    EXPECT_THAT(result.err, HasSubstr("the board where rigs A and B both see it (1 of 5)"));
    EXPECT_THAT(result.err, HasSubstr("nothing is missing"));
}

TEST_F(LiveCalibration, waits_for_the_board_on_the_floor_that_gives_the_world_its_place) {
    const std::vector<BoardPattern> patterns = floor_and_hand_board();
    save_board(file("floor.toml"), patterns[0]);
    save_board(file("hand.toml"), patterns[1]);
    RenderedStage stage(patterns, 480, 9);
    constexpr int first_rig = 1;
    const char* names[] = {"A", "B"};
    for (int i = 0; i < 7; ++i) {
        std::vector<RenderedStage::StandingBoard> standing = {
            {1, stage.board_before_pair(first_rig)}};
        if (i == 5) standing.push_back({0, stage.board_on_floor()});
        for (int r = 0; r < 2; ++r)
            write_film(names[r], i, stage.film(first_rig + r, 0, standing, {}),
                       stage.film(first_rig + r, 1, standing, {}));
    }
    for (int r = 0; r < 2; ++r) {
        StereoCalibration known = stage.truth(first_rig + r);
        known.world_from_left = Pose::Identity();
        compute_rectification(known, 0);
        save_calibration(file(std::string(names[r]) + "/calibration.yaml"), known,
                         {"2026-01-01T00:00:00Z", "test", 0.02, 0.02, 12});
        start_filming_rig(names[r]);
    }
    const ProgramResult result =
        calibrate({"stage", "--board-file", file("floor.toml"), "--board-file", file("hand.toml"),
                   "--rig", "A=" + file("A"), "--rig", "B=" + file("B"), "--floor-first",
                   "--floor-board", "floor", "-o", file("world")});
    ASSERT_EQ(result.status, 0) << result.err << rigs_[0]->err() << rigs_[1]->err();
    for (int r = 0; r < 2; ++r)
        EXPECT_LT((load_calibration(file("world/" + std::string(names[r]) + ".yaml"))
                       .world_from_left.translation() -
                   stage.truth(first_rig + r).world_from_left.translation())
                      .norm(),
                  0.02)
            << r;
}

TEST_F(LiveCalibration, names_a_board_of_another_size_instead_of_waiting_for_it) {
    RenderedStage stage(chessboard_pattern("7x5", 0.1), 320, 2);
    for (int i = 0; i < 3; ++i) {
        const Pose world_from_board = stage.world_from_board_near(0);
        write_film("A", i, stage.film(0, 0, world_from_board, {}),
                   stage.film(0, 1, world_from_board, {}));
    }
    start_filming_rig("A");
    const ProgramResult result = calibrate(
        with_board({"stereo", "--rig", "A=" + file("kept"), "-o", file("calibration.yaml")}));
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("a board of 7x5 inner corners, not 9x6"));
    EXPECT_FALSE(std::filesystem::exists(file("calibration.yaml")));
}

TEST_F(LiveCalibration, says_what_is_known_of_a_rig_that_sends_nothing) {
    const ProgramResult silent = calibrate(with_board(
        {"stereo", "--rig", "A=" + file("kept"), "-o", file("c.yaml"), "--patience-s", "1"}));
    EXPECT_EQ(silent.status, 1);
    EXPECT_THAT(silent.err, HasSubstr("no picture came for 1 s: rig A: "));
    const ProgramResult unknown =
        calibrate(with_board({"stereo", "--rig", "C=" + file("kept"), "-o", file("c.yaml")}));
    EXPECT_EQ(unknown.status, 1);
    EXPECT_THAT(unknown.err, HasSubstr("has no rig named C; it has A, B"));
}

/// Two rigs of the virtual stage, 30 degrees apart, at work, and their calibrations as files.
class LiveCheck : public LiveCalibration {
  protected:
    static constexpr int width_px = 400, height_px = 300;

    LiveCheck() {
        for (const char* name : {"A", "B"}) {
            const double azimuth_deg = *name == 'A' ? -15 : 15;
            start_rig(name, "",
                      fmt::format("width_px = {}\nheight_px = {}\n[virtual_rig]\nazimuth_deg = {}\n"
                                  "distance_m = 3.5\nbaseline_m = 0.2\n"
                                  "[match]\nmatcher = \"exact\"\ndisparities = 64\n",
                                  width_px, height_px, azimuth_deg));
            VirtualRigPlacement placement;
            placement.azimuth_rad = azimuth_deg * std::numbers::pi / 180;
            placement.elevation_rad = 10 * std::numbers::pi / 180;
            placement.distance_m = 3.5;
            placement.baseline_m = 0.2;
            placement.field_of_view_rad = 50 * std::numbers::pi / 180;
            placement.width_px = width_px;
            placement.height_px = height_px;
            save(name, ideal_virtual_rig(placement));
        }
    }

    void save(const std::string& rig, const StereoCalibration& calibration) {
        save_calibration(file(rig + ".yaml"), calibration,
                         {"2026-01-01T00:00:00Z", "test", 0.1, 0.1, 9});
    }

    ProgramResult run(const std::string& command, std::vector<std::string> more) const {
        std::vector<std::string> arguments{command, "--rig", "A=" + file("A.yaml"), "--rig",
                                           "B=" + file("B.yaml")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return calibrate(arguments);
    }
};

TEST_F(LiveCheck, judges_a_running_stage_and_notices_a_rig_that_was_moved) {
    const ProgramResult good = run("check", {"--history", file("history.jsonl")});
    const auto judged = nlohmann::json::parse(good.out);
    // Pictures as small as these hold few features that both rigs see.
    const bool place_is_known = judged.at("not_known").empty();
    EXPECT_EQ(good.status, place_is_known ? 0 : 3) << good.err << rigs_[0]->err();
    EXPECT_EQ(judged.at("verdict"), place_is_known ? "good" : "unknown");
    const auto measures = judged.at("measures");
    ASSERT_EQ(measures.size(), 6u);
    for (const auto& m : measures) {
        EXPECT_TRUE(m.at("verdict") == "good" ||
                    (m.at("what") == "place" && !place_is_known && m.at("verdict") == "unknown"))
            << m;
        EXPECT_FALSE(m.at("unit").get<std::string>().empty());
    }
    EXPECT_THAT(good.err, Not(HasSubstr("works with calibration"))) << good.err;

    StereoCalibration moved = load_calibration(file("B.yaml"));
    moved.world_from_left.translation() += Eigen::Vector3d(0.3, 0, 0.3);
    save("B", moved);
    // One instant is judged, and how much both rigs see of it changes as performers walk: it is
    // good at none, and bad at most.
    ProgramResult bad;
    int checks = 1;
    for (std::string verdict; verdict != "bad" && checks < 6; ++checks) {
        bad = run("check", {"--history", file("history.jsonl"), "--html", file("health.html")});
        ASSERT_NE(bad.out, "") << bad.err;
        verdict = nlohmann::json::parse(bad.out).at("verdict");
        EXPECT_NE(verdict, "good") << bad.out;
    }
    EXPECT_EQ(nlohmann::json::parse(bad.out).at("verdict"), "bad") << bad.out;
    EXPECT_EQ(bad.status, 1) << bad.err;
    EXPECT_THAT(bad.out, HasSubstr("% of the surfaces that rig"));
    EXPECT_THAT(bad.err, HasSubstr("rig B works with calibration"));
    std::ifstream history(file("history.jsonl"));
    int lines = 0;
    for (std::string line; std::getline(history, line);) ++lines;
    EXPECT_EQ(lines, checks);
}

TEST_F(LiveCheck, matches_the_colours_of_a_running_stage) {
    const ProgramResult result = run("colour", {"-o", file("colour")});
    ASSERT_EQ(result.status, 0) << result.err << rigs_[0]->err();
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("reference"), "A");
    // One light, equal sensors: there is next to nothing to correct.
    const ColourCorrection b = load_colour(file("colour/B.colour.toml"));
    EXPECT_LT((b.matrix - Eigen::Matrix3d::Identity()).norm(), 0.2);
    EXPECT_LT(json.at("rigs").at(1).at("delta_e_after").get<double>(), 1.5);
}

}  // namespace
}  // namespace vantage

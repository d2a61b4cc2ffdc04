#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/board/board_file.h"
#include "common/board/board_finder.h"
#include "common/config/calibration_file.h"
#include "common/image/image_file.h"
#include "tests/support/boards/rendered_stage.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

using testing::HasSubstr;

TEST(BoardCommand, draws_a_cube_as_a_page_and_a_picture_a_face_and_describes_it) {
    const TemporaryFolder folder;
    const std::string cube = folder.path() / "cube";
    const ProgramResult result =
        run_to_end(VANTAGE_CALIB, {"board", "--board", "3x3", "--square-m", "0.03", "--dictionary",
                                   "4X4_100", "--faces", "5", "-o", cube, "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(nlohmann::json::parse(result.out).at("pngs").size(), 5u);
    const std::vector<BoardPattern> faces = load_body(cube + ".toml");
    ASSERT_EQ(faces.size(), 5u);
    EXPECT_EQ(faces[4].first_marker, 32);
    // The picture of a face shows the markers that its description says, at 300 dots an inch.
    CalibrationBoards boards;
    boards.add("cube", faces);
    const GreyImage picture = to_grey(read_colour_image(cube + "_3.png"));
    EXPECT_EQ(picture.cols, 6 * 354);
    const BoardSighting seen = find_board(picture, boards);
    ASSERT_EQ(seen.corners.size(), 9u) << seen.reason;
    EXPECT_EQ(seen.corners.front().board, 2);
}

TEST(BoardCommand, draws_on_a_sheet_and_refuses_what_does_not_fit_it) {
    const TemporaryFolder folder;
    const std::string board = folder.path() / "board";
    const ProgramResult refused =
        run_to_end(VANTAGE_CALIB,
                   {"board", "--board", "9x6", "--square-m", "0.04", "--paper", "a3", "-o", board});
    EXPECT_EQ(refused.status, 1);
    EXPECT_THAT(refused.err, HasSubstr("take squares of 31 mm or less"));
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    const ProgramResult drawn =
        run_to_end(VANTAGE_CALIB, {"board", "--board", "9x6", "--paper", "a3", "-o", board});
    ASSERT_EQ(drawn.status, 0) << drawn.err;
    EXPECT_THAT(drawn.out, HasSubstr("which fits a3"));
    EXPECT_DOUBLE_EQ(load_board(board + ".toml").square_m, 0.031);
    EXPECT_DOUBLE_EQ(load_board(board + ".toml").marker_m, 0.0217);
}

TEST(BoardCommand, is_not_all_that_follows_the_description_of_a_board) {
    const auto refusal = [](std::vector<std::string> words) {
        words.insert(words.end(), {"--board-file", "board.toml", "p1.png", "p2.png"});
        const ProgramResult result = run_to_end(VANTAGE_CALIB, words);
        EXPECT_EQ(result.status, 1);
        return result.err;
    };
    EXPECT_THAT(refusal({"intrinsics"}),
                HasSubstr("p1.png is no description of a board (.toml): pictures go behind "
                          "--images"));
    EXPECT_THAT(refusal({"stereo", "-o", "c.yaml"}), HasSubstr("behind --left and --right"));
}

TEST(BoardCommand, names_the_sheet_that_was_asked_for_though_a_smaller_one_would_do) {
    const TemporaryFolder folder;
    const ProgramResult drawn = run_to_end(
        VANTAGE_CALIB, {"board", "--board", "9x6", "--paper", "a4", "-o", folder.path() / "board"});
    EXPECT_THAT(drawn.out, HasSubstr("which fits a4"));
}

TEST(BoardCommand, the_file_of_a_board_is_not_its_corners) {
    const ProgramResult result =
        run_to_end(VANTAGE_CALIB, {"intrinsics", "--board", "board.toml", "one.png"});
    EXPECT_NE(result.status, 0);
    EXPECT_THAT(result.err, HasSubstr("give it as --board-file board.toml"));
}

TEST(BoardCommand, keeps_what_somebody_measured_on_the_print) {
    const TemporaryFolder folder;
    const std::string board = folder.path() / "board", file = board + ".toml";
    const std::vector<std::string> command{"board", "--board", "9x6", "--square-m",
                                           "0.04",  "-o",      board};
    const auto text = [&] {
        std::ifstream in(file);
        return std::string(std::istreambuf_iterator<char>(in), {});
    };
    ASSERT_EQ(run_to_end(VANTAGE_CALIB, command).status, 0);
    EXPECT_THAT(text(), HasSubstr("marker_m = 0.028\n"));
    // The same board again changes nothing.
    ASSERT_EQ(run_to_end(VANTAGE_CALIB, command).status, 0);
    std::string measured = text();
    measured.replace(measured.find("square_m = 0.04"), 15, "square_m = 0.0397");
    std::ofstream(file) << measured;
    std::filesystem::remove(board + ".pdf");
    const ProgramResult again = run_to_end(VANTAGE_CALIB, command);
    EXPECT_EQ(again.status, 1);
    EXPECT_THAT(again.err, HasSubstr("says square_m = 0.0397, perhaps as measured, and this board "
                                     "has 0.04: nothing is written"));
    EXPECT_EQ(text(), measured);
    EXPECT_FALSE(std::filesystem::exists(board + ".pdf"));
}

TEST(BoardCommand, refuses_more_faces_than_there_are_markers_and_writes_nothing) {
    const TemporaryFolder folder;
    const ProgramResult result =
        run_to_end(VANTAGE_CALIB, {"board", "--board", "4x4", "--square-m", "0.03", "--dictionary",
                                   "4X4_50", "--faces", "5", "-o", folder.path() / "cube"});
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("dictionary 4X4_50 has 50; take a larger one"));
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

/// Two neighbours of a rendered stage; one board lies on the floor, another is carried about.
class SeveralBoardsCommand : public testing::Test {
  protected:
    static constexpr int first_rig = 1;

    SeveralBoardsCommand() {
        const std::vector<BoardPattern> patterns = floor_and_hand_board();
        save_board(file("floor.toml"), patterns[0]);
        save_board(file("hand.toml"), patterns[1]);
        RenderedStage stage(patterns, 480, 9);
        for (const int r : {0, 1}) {
            truths_[r] = stage.truth(first_rig + r);
            StereoCalibration known = truths_[r];
            known.world_from_left = Pose::Identity();
            compute_rectification(known, 0);
            std::filesystem::create_directories(file(name(r)));
            save_calibration(file(name(r)) + "/calibration.yaml", known,
                             {"2026-01-01T00:00:00Z", "test", 0.02, 0.02, 12});
        }
        for (int i = 0; i < 6; ++i) {
            const std::vector<RenderedStage::StandingBoard> standing = {
                {0, stage.board_on_floor()}, {1, stage.board_before_pair(first_rig)}};
            for (const int r : {0, 1})
                for (const int side : {0, 1})
                    write_grey_image(
                        fmt::format("{}/{}{}.png", file(name(r)), side == 0 ? "left" : "right", i),
                        stage.film(first_rig + r, side, standing, {}));
        }
    }

    static std::string name(int r) { return r == 0 ? "A" : "B"; }
    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

    ProgramResult stage(std::vector<std::string> more) const {
        std::vector<std::string> arguments = {
            "stage",           "--board-file", file("floor.toml"), "--board-file",
            file("hand.toml"), "--rig",        "A=" + file("A"),   "--rig",
            "B=" + file("B"),  "-o",           file("world"),      "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_to_end(VANTAGE_CALIB, arguments);
    }

    TemporaryFolder folder_;
    StereoCalibration truths_[2];
};

TEST_F(SeveralBoardsCommand, places_the_world_at_the_board_that_is_named) {
    const ProgramResult result = stage({"--floor", "0", "--floor-board", "floor"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("bodies").size(), 2u);
    // The one on the floor is a picture of a board that lies still: it counts once.
    EXPECT_EQ(json.at("ties").at(0).at("shared_instants"), 6);
    for (const int r : {0, 1})
        EXPECT_LT(
            (load_calibration(file("world/" + name(r) + ".yaml")).world_from_left.translation() -
             truths_[r].world_from_left.translation())
                .norm(),
            0.015)
            << r;
}

TEST_F(SeveralBoardsCommand, asks_which_one_lies_on_the_floor_and_writes_nothing) {
    const ProgramResult unclear = stage({"--floor", "0"});
    EXPECT_EQ(unclear.status, 1);
    EXPECT_THAT(unclear.err, HasSubstr("at instant 0 the rigs see floor, hand: say which lies on "
                                       "the floor (--floor-board NAME)"));
    const ProgramResult unknown = stage({"--floor", "0", "--floor-board", "flor"});
    EXPECT_EQ(unknown.status, 1);
    EXPECT_THAT(unknown.err, HasSubstr("no board is named flor; there are floor, hand"));
    EXPECT_FALSE(std::filesystem::exists(file("world")));
}

}  // namespace
}  // namespace vantage

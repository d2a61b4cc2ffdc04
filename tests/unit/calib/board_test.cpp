#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "calib_tools/board/board_drawing.h"
#include "calib_tools/board/board_file.h"
#include "calib_tools/board/board_finder.h"
#include "calib_tools/board/charuco_finder.h"
#include "common/base/error.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using testing::HasSubstr;

BoardPattern charuco(int columns, int rows) {
    BoardPattern pattern = chessboard_pattern(fmt::format("{}x{}", columns, rows), 0.04);
    pattern.kind = BoardKind::charuco;
    pattern.marker_m = 0.028;
    pattern.dictionary = "5X5_250";
    return pattern;
}

TEST(Board, comes_back_from_its_description) {
    const TemporaryFolder folder;
    const BoardPattern pattern = charuco(8, 5);
    save_board(folder.path() / "b.toml", pattern);
    const BoardPattern loaded = load_board(folder.path() / "b.toml");
    EXPECT_EQ(loaded.kind, BoardKind::charuco);
    EXPECT_EQ(loaded.size_name(), "8x5");
    EXPECT_DOUBLE_EQ(loaded.square_m, 0.04);
    EXPECT_DOUBLE_EQ(loaded.marker_m, 0.028);
    EXPECT_EQ(loaded.dictionary, "5X5_250");
}

TEST(Board, with_more_markers_than_its_dictionary_has_is_refused) {
    const TemporaryFolder folder;
    BoardPattern pattern = charuco(20, 20);
    pattern.dictionary = "4X4_50";
    save_board(folder.path() / "b.toml", pattern);
    EXPECT_THROW(load_board(folder.path() / "b.toml"), Error);
}

TEST(Board, drawn_as_charuco_is_found_where_it_was_drawn_even_half_hidden) {
    const BoardPattern pattern = charuco(8, 5);
    GreyImage picture = draw_board(pattern, 40);
    cv::GaussianBlur(picture, picture, {}, 0.8);
    picture(cv::Rect(0, 0, 200, picture.rows)).setTo(130);
    const BoardSighting sighting = find_board(picture, pattern);
    ASSERT_TRUE(sighting.found()) << sighting.reason;
    // Four of eight columns lie beyond the cover.
    EXPECT_EQ(sighting.corners.size(), 20u);
    for (const BoardCorner& corner : sighting.corners) {
        // One square of margin and one to the first inner corner; an edge lies between two pixels.
        const Eigen::Vector2d drawn(79.5 + 40 * (corner.id % 8), 79.5 + 40 * (corner.id / 8));
        EXPECT_LT((corner.pixel - drawn).norm(), 0.05);
    }
}

TEST(Board, drawn_as_charuco_tells_how_much_of_it_glare_hides) {
    const BoardPattern pattern = charuco(8, 5);
    GreyImage picture = draw_board(pattern, 40);
    picture = picture * 0.8;
    EXPECT_EQ(find_board(picture, pattern).burnt_out_share, 0);
    // Three by two of the nine by six squares, which begin a square of margin from the border.
    picture(cv::Rect(280, 40, 120, 80)).setTo(255);
    const BoardSighting sighting = find_board(picture, pattern);
    ASSERT_TRUE(sighting.found()) << sighting.reason;
    EXPECT_NEAR(sighting.burnt_out_share, 6.0 / 54, 0.01);
}

TEST(Board, seen_in_a_mirror_is_named) {
    const BoardPattern pattern = charuco(8, 5);
    GreyImage mirrored;
    cv::flip(draw_board(pattern, 40), mirrored, 1);
    const BoardSighting sighting = find_board(mirrored, pattern);
    EXPECT_FALSE(sighting.found());
    EXPECT_TRUE(sighting.mirrored);
    EXPECT_THAT(sighting.reason, HasSubstr("mirrored"));
}

TEST(Board, set_comes_back_from_its_description_and_is_no_flat_board) {
    const TemporaryFolder folder;
    std::vector<BoardPattern> faces(3, charuco(4, 4));
    for (int i = 0; i < 3; ++i) faces[static_cast<std::size_t>(i)].first_marker = 12 * i;
    const std::filesystem::path file = folder.path() / "cube.toml";
    save_body(file, faces);
    const std::vector<BoardPattern> loaded = load_body(file);
    ASSERT_EQ(loaded.size(), 3u);
    EXPECT_EQ(loaded[2].first_marker, 24);
    EXPECT_EQ(loaded[2].size_name(), "4x4");
    EXPECT_THAT(thrown_sentence([&] { load_board(file); }),
                HasSubstr("describes a body of 3 boards"));
    faces[2].first_marker = 245;
    save_body(file, faces);
    EXPECT_THAT(thrown_sentence([&] { load_body(file); }),
                HasSubstr("that begins at marker 245 needs 12 markers"));
}

TEST(Board, set_whose_boards_cannot_be_told_apart_is_refused) {
    BoardPattern second = charuco(8, 5);
    second.first_marker = 20;
    BoardSet sharing(charuco(8, 5));
    sharing.add("second", {second});
    // Nine by six squares hold 27 markers.
    EXPECT_THAT(thrown_sentence([&] { sharing.validate(); }),
                HasSubstr("8x5 and second share markers of 5X5 (from 0 and from 20): print one of "
                          "them with other markers (board --first-marker 47)"));
    BoardSet with_chessboard(charuco(8, 5));
    with_chessboard.add("plain", {chessboard_pattern("9x6", 0.04)});
    EXPECT_THAT(thrown_sentence([&] { with_chessboard.validate(); }),
                HasSubstr("plain is a plain chessboard"));
    second.first_marker = 27;
    BoardSet apart(charuco(8, 5));
    apart.add("second", {second});
    EXPECT_NO_THROW(apart.validate());
}

TEST(Board, set_is_found_by_its_markers_and_its_corners_are_numbered_through) {
    const BoardPattern first = charuco(5, 4);
    BoardPattern second = first;
    second.first_marker = marker_count(first);
    BoardSet set(first);
    set.add("second", {second});
    GreyImage picture;
    cv::vconcat(draw_board(second, 30), draw_board(first, 30), picture);
    cv::GaussianBlur(picture, picture, {}, 0.8);
    const BoardSighting sighting = find_board(picture, set);
    ASSERT_EQ(sighting.corners.size(), 40u) << sighting.reason;
    for (std::size_t i = 0; i < 40; ++i) {
        const BoardCorner& corner = sighting.corners[i];
        const int on_board = static_cast<int>(i) % 20;
        EXPECT_EQ(corner.id, static_cast<int>(i));
        EXPECT_EQ(corner.board, i < 20 ? 0 : 1);
        // The second one stands above the first, whose picture is 7 squares and the margin high.
        const Eigen::Vector2d drawn(59.5 + 30 * (on_board % 5),
                                    59.5 + 30 * (on_board / 5) + (i < 20 ? 210 : 0));
        EXPECT_LT((corner.pixel - drawn).norm(), 0.05);
    }
}

TEST(Board, set_as_pdf_has_a_page_a_face_with_a_frame_to_cut_along) {
    const std::vector<std::byte> bytes = board_as_pdf({charuco(4, 4), charuco(4, 4)});
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    EXPECT_THAT(text, HasSubstr("/Count 2"));
    // 5 squares, a square of margin and 10 mm around the frame either side: 0.3 m = 850.394 points.
    EXPECT_THAT(text, HasSubstr("0 0 850.39"));
}

TEST(Board, as_pdf_has_a_page_of_its_true_size) {
    const std::vector<std::byte> bytes = board_as_pdf({charuco(8, 5)});
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    EXPECT_TRUE(text.starts_with("%PDF"));
    // 9 x 6 squares and a square of margin either side: 0.44 m = 1247.24 points.
    EXPECT_THAT(text, HasSubstr("0 0 1247.24"));
    EXPECT_THROW(board_as_pdf({chessboard_pattern("9x6", 1.0)}), Error);
}

}  // namespace
}  // namespace vantage

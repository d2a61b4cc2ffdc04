#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "calib_tools/board/board_drawing.h"
#include "calib_tools/board/paper.h"
#include "common/base/error.h"
#include "common/board/board_file.h"
#include "common/board/board_finder.h"
#include "common/board/charuco_finder.h"
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

TEST(Board, whose_file_was_corrected_to_something_impossible_is_refused_with_its_file) {
    const TemporaryFolder folder;
    BoardPattern pattern = charuco(8, 5);
    pattern.square_m = pattern.marker_m / 2;
    const std::filesystem::path file = folder.path() / "b.toml";
    save_board(file, pattern);
    const std::string sentence = thrown_sentence([&] { load_board(file); });
    EXPECT_THAT(sentence, HasSubstr(file.string()));
    EXPECT_THAT(sentence, HasSubstr("does not fit into a square"));
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
        const int column = corner.id % 8, row = corner.id / 8;
        const Eigen::Vector2d drawn(79.5 + 40 * column, 79.5 + 40 * row);
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

/// Every corner of the board, drawn with 40 px a square, within a twentieth of a pixel.
void expect_where_drawn(const BoardSighting& sighting, const BoardPattern& pattern) {
    ASSERT_EQ(sighting.corners.size(), static_cast<std::size_t>(pattern.corner_count()))
        << sighting.reason;
    for (const BoardCorner& corner : sighting.corners) {
        const int column = corner.id % pattern.columns, row = corner.id / pattern.columns;
        const Eigen::Vector2d drawn(79.5 + 40 * column, 79.5 + 40 * row);
        EXPECT_LT((corner.pixel - drawn).norm(), 0.05) << corner.id;
    }
}

GreyImage drawn_softly(const BoardPattern& pattern) {
    GreyImage picture = draw_board(pattern, 40);
    cv::GaussianBlur(picture, picture, {}, 0.8);
    return picture;
}

TEST(Board, printed_inverted_is_recognised_and_its_black_is_no_glare) {
    const BoardPattern pattern = charuco(8, 5);
    const BoardSighting straight = find_board(drawn_softly(pattern), pattern);
    EXPECT_FALSE(straight.inverted);
    GreyImage inverted;
    cv::bitwise_not(drawn_softly(pattern), inverted);
    const BoardSighting sighting = find_board(inverted * 0.8, pattern);
    expect_where_drawn(sighting, pattern);
    EXPECT_TRUE(sighting.inverted);
    EXPECT_EQ(sighting.burnt_out_share, 0);
    CalibrationBoards boards(pattern);
    BoardPattern other = pattern;
    other.first_marker = 60;
    boards.add("other", {other});
    EXPECT_TRUE(find_board(inverted, boards).inverted);
    cv::flip(inverted, inverted, 1);
    EXPECT_TRUE(find_board(inverted, pattern).mirrored);
}

TEST(Board, of_the_legacy_layout_is_recognised_whatever_its_description_says) {
    for (const auto& [columns, rows] : {std::pair(8, 5), std::pair(7, 5), std::pair(6, 7)}) {
        BoardPattern pattern = charuco(columns, rows), legacy = pattern;
        legacy.legacy = true;
        for (const bool printed_legacy : {false, true})
            for (const bool described_legacy : {false, true}) {
                const GreyImage picture = drawn_softly(printed_legacy ? legacy : pattern);
                const BoardSighting sighting =
                    find_board(picture, described_legacy ? legacy : pattern);
                expect_where_drawn(sighting, pattern);
                EXPECT_EQ(sighting.legacy, printed_legacy);
                EXPECT_TRUE(sighting.layout_is_sure);
            }
        // With an odd count of rows of squares there is one layout only.
        BoardPattern odd = charuco(columns, rows + 1);
        odd.legacy = true;
        EXPECT_FALSE(find_board(drawn_softly(charuco(columns, rows + 1)), odd).legacy);
    }
}

TEST(Board, of_the_legacy_layout_has_its_first_marker_in_the_upper_left_square) {
    BoardPattern pattern = charuco(4, 5);
    EXPECT_EQ(marker_square(pattern, 0), cv::Point(1, 0));
    EXPECT_EQ(marker_square(pattern, 2), cv::Point(0, 1));
    pattern.legacy = true;
    EXPECT_EQ(marker_square(pattern, 0), cv::Point(0, 0));
    EXPECT_EQ(marker_square(pattern, 3), cv::Point(1, 1));
    const TemporaryFolder folder;
    save_board(folder.path() / "b.toml", pattern);
    EXPECT_TRUE(load_board(folder.path() / "b.toml").legacy);
}

TEST(Paper, holds_boards_in_either_direction_and_says_how_large_their_squares_may_be) {
    const Paper a3 = paper_named("A3");
    const double square_m = largest_square_m(charuco(9, 6), false, a3);
    EXPECT_DOUBLE_EQ(square_m, 0.031);                                    // (297 - 14) / 9 mm
    EXPECT_DOUBLE_EQ(largest_square_m(charuco(6, 9), false, a3), 0.033);  // 297 / 9 mm
    EXPECT_DOUBLE_EQ(largest_square_m(charuco(9, 6), false, paper_named("600x400")), 0.042);
    EXPECT_THAT(thrown_sentence([&] { require_fit(charuco(9, 6), false, a3); }),
                HasSubstr("a 9x6 board of 40 mm squares needs 480 x 374 mm with its margin and "
                          "caption, and a3 is 420 x 297 mm: take squares of 31 mm or less"));
    EXPECT_THAT(thrown_sentence([] { paper_named("a5"); }),
                HasSubstr("'a5' is no paper: there are letter, a4, a3, a2, and WIDTHxHEIGHT"));
    for (const char* wrong : {"0x100", "100", "x", "1e9x2", "100x-1"})
        EXPECT_THROW(paper_named(wrong), Error) << wrong;
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
    CalibrationBoards sharing(charuco(8, 5));
    sharing.add("second", {second});
    // Nine by six squares hold 27 markers.
    EXPECT_THAT(thrown_sentence([&] { sharing.validate(); }),
                HasSubstr("8x5 and second share markers of 5X5 (from 0 and from 20): print one of "
                          "them with other markers (board --first-marker 47)"));
    CalibrationBoards with_chessboard(charuco(8, 5));
    with_chessboard.add("plain", {chessboard_pattern("9x6", 0.04)});
    EXPECT_THAT(thrown_sentence([&] { with_chessboard.validate(); }),
                HasSubstr("plain is a plain chessboard"));
    second.first_marker = 27;
    CalibrationBoards apart(charuco(8, 5));
    apart.add("second", {second});
    EXPECT_NO_THROW(apart.validate());
}

TEST(Board, set_is_found_by_its_markers_and_its_corners_are_numbered_through) {
    const BoardPattern first = charuco(5, 4);
    BoardPattern second = first;
    second.first_marker = marker_count(first);
    CalibrationBoards set(first);
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
        const int column = on_board % 5, row = on_board / 5;
        const Eigen::Vector2d drawn(59.5 + 30 * column, 59.5 + 30 * row + (i < 20 ? 210 : 0));
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

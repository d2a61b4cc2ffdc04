#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "calib_tools/board/board_drawing.h"
#include "calib_tools/board/board_file.h"
#include "calib_tools/board/board_finder.h"
#include "common/base/error.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

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
    EXPECT_THAT(sighting.reason, testing::HasSubstr("mirrored"));
}

TEST(Board, as_pdf_has_a_page_of_its_true_size) {
    const std::vector<std::byte> bytes = board_as_pdf(charuco(8, 5));
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    EXPECT_TRUE(text.starts_with("%PDF"));
    // 9 x 6 squares and a square of margin either side: 0.44 m = 1247.24 points.
    EXPECT_THAT(text, testing::HasSubstr("0 0 1247.24"));
    EXPECT_THROW(board_as_pdf(chessboard_pattern("9x6", 1.0)), Error);
}

}  // namespace
}  // namespace vantage

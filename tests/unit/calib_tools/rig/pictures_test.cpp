#include <fstream>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "calib_tools/board/board_drawing.h"
#include "calib_tools/pictures/seen_picture.h"
#include "common/base/error.h"
#include "common/board/chessboard_finder.h"
#include "common/board/corner_refiner.h"
#include "common/image/image_file.h"
#include "common/image/picture_list.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

using testing::HasSubstr;

std::vector<std::filesystem::path> touch(const std::filesystem::path& folder,
                                         const std::vector<std::string>& names) {
    std::vector<std::filesystem::path> files;
    for (const std::string& name : names) {
        std::ofstream(folder / name) << "x";
        files.push_back(folder / name);
    }
    return files;
}

/// A chessboard that fills the picture but for a white margin of one square, tilted in perspective.
GreyImage draw_chessboard(int columns, int rows, double blur_px, int square_px = 30) {
    GreyImage flat((rows + 3) * square_px, (columns + 3) * square_px, uchar{225});
    for (int r = 0; r <= rows; ++r)
        for (int c = 0; c <= columns; ++c)
            if ((r + c) % 2 == 0)
                flat(cv::Rect((c + 1) * square_px, (r + 1) * square_px, square_px, square_px))
                    .setTo(30);
    const cv::Matx33d tilt(0.9, 0.05, 12, -0.04, 0.92, 18, -1e-4, 1.2e-4, 1);
    GreyImage picture;
    cv::warpPerspective(flat, picture, tilt, flat.size(), cv::INTER_AREA, cv::BORDER_CONSTANT,
                        cv::Scalar(120));
    cv::GaussianBlur(picture, picture, {}, blur_px);
    return picture;
}

TEST(PictureList, sorts_by_number_and_refuses_patterns_without_files) {
    const TemporaryFolder folder;
    touch(folder.path(), {"a10.png", "a9.png", "a1.png"});
    const auto files = expand_pictures((folder.path() / "a*.png").string());
    ASSERT_EQ(files.size(), 3u);
    EXPECT_EQ(files[1].filename(), "a9.png");
    EXPECT_EQ(files[2].filename(), "a10.png");
    EXPECT_THROW(expand_pictures((folder.path() / "b*.png").string()), Error);
}

TEST(PictureList, takes_the_files_that_a_shell_expanded_each_once) {
    const TemporaryFolder folder;
    touch(folder.path(), {"a10.png", "a9.png", "b1.png"});
    const auto path = [&](const char* name) { return (folder.path() / name).string(); };
    const auto files = expand_pictures(
        std::vector<std::string>{path("a10.png"), path("a9.png"), path("a9.png"), path("b*")});
    ASSERT_EQ(files.size(), 3u);
    EXPECT_EQ(files[0].filename(), "a9.png");
    EXPECT_EQ(files[2].filename(), "b1.png");
}

TEST(PictureList, pairs_by_number_and_names_pictures_without_partner) {
    const TemporaryFolder folder;
    const auto left = touch(folder.path(), {"cam0_001.png", "cam0_002.png", "cam0_004.png"});
    const auto right = touch(folder.path(), {"cam1_002.png", "cam1_003.png", "cam1_004.png"});
    const PicturePairs pairs = pair_pictures(left, right);
    ASSERT_EQ(pairs.pairs.size(), 2u);
    EXPECT_EQ(pairs.pairs[0].second.filename(), "cam1_002.png");
    EXPECT_EQ(pairs.alone.size(), 2u);
}

TEST(PictureList, finds_the_number_that_counts_even_before_the_camera_in_the_name) {
    const TemporaryFolder folder;
    const auto files = touch(folder.path(), {"007_cam1.png", "012_cam1.png"});
    EXPECT_THAT(picture_numbers(files), testing::ElementsAre(7, 12));
}

TEST(CornerRefiner, finds_a_blurred_noisy_corner_to_a_fiftieth_of_a_pixel) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0, 2);
    double worst = 0;
    for (int trial = 0; trial < 20; ++trial) {
        const double x0 = 20 + 0.05 * trial, y0 = 19.3 + 0.037 * trial;
        GreyImage picture(41, 43);
        for (int y = 0; y < picture.rows; ++y)
            for (int x = 0; x < picture.cols; ++x) {
                const double d1 = 0.2 * (x - x0) + 0.98 * (y - y0);
                const double d2 = 0.95 * (x - x0) - 0.3 * (y - y0);
                picture(y, x) = cv::saturate_cast<uchar>(
                    128 + 80 * std::erf(d1 / 1.3) * std::erf(d2 / 1.3) + noise(random));
            }
        const auto fit = fit_corner(picture, {x0 + 0.8, y0 - 0.7}, {0.98, -0.2}, {0.3, 0.95}, 12);
        ASSERT_TRUE(fit);
        worst = std::max(worst, (fit->pixel - Eigen::Vector2d(x0, y0)).norm());
        EXPECT_NEAR(fit->blur_px, 1.3 / std::sqrt(2), 0.15);
    }
    EXPECT_LT(worst, 0.02);
}

TEST(CornerRefiner, finds_no_corner_in_an_even_surface) {
    EXPECT_FALSE(fit_corner(GreyImage(31, 31, uchar{90}), {15, 15}, {1, 0}, {0, 1}, 10));
}

TEST(ChessboardFinder, numbers_a_board_alike_from_every_side) {
    const BoardPattern pattern = chessboard_pattern("7x4", 0.03);
    const GreyImage picture = draw_chessboard(7, 4, 0.8);
    GreyImage turned;
    cv::rotate(picture, turned, cv::ROTATE_180);
    const BoardSighting upright = find_chessboard(picture, pattern);
    const BoardSighting upside_down = find_chessboard(turned, pattern);
    ASSERT_EQ(upright.corners.size(), 28u);
    ASSERT_EQ(upside_down.corners.size(), 28u);
    for (std::size_t i = 0; i < 28; ++i) {
        const Eigen::Vector2d back(picture.cols - 1 - upside_down.corners[i].pixel.x(),
                                   picture.rows - 1 - upside_down.corners[i].pixel.y());
        EXPECT_LT((upright.corners[i].pixel - back).norm(), 0.05);
    }
}

TEST(ChessboardFinder, names_the_size_of_another_board) {
    const GreyImage picture = draw_chessboard(7, 4, 0.8);
    for (const char* asked : {"6x3", "8x5", "9x6"}) {
        const BoardPattern pattern = chessboard_pattern(asked, 0.03);
        EXPECT_FALSE(find_chessboard(picture, pattern).found()) << asked;
        const auto other = find_other_size(picture, pattern);
        ASSERT_TRUE(other) << asked;
        EXPECT_EQ(other->size_name(), "7x4");
    }
}

TEST(SeenPictures, give_reasons_for_damage_blur_and_other_sizes) {
    const TemporaryFolder folder;
    const BoardPattern pattern = chessboard_pattern("7x4", 0.03);
    std::vector<std::filesystem::path> files;
    for (int i = 0; i < 4; ++i) {
        files.push_back(folder.path() / ("good" + std::to_string(i) + ".png"));
        write_grey_image(files.back(), draw_chessboard(7, 4, 0.7));
    }
    files.push_back(folder.path() / "blurred.png");
    write_grey_image(files.back(), draw_chessboard(7, 4, 3.0));
    files.push_back(folder.path() / "small.png");
    write_grey_image(files.back(), draw_chessboard(7, 4, 0.7, 20));
    files.push_back(folder.path() / "text.png");
    std::ofstream(files.back()) << "no picture";
    files.push_back(folder.path() / "cut.jpg");
    write_grey_image(files.back(), draw_chessboard(7, 4, 0.7));
    std::filesystem::resize_file(files.back(), std::filesystem::file_size(files.back()) / 2);

    std::vector<SeenPicture> seen = look_at_pictures(files, pattern);
    require_one_size(seen);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(seen[i].sighting.found());
    for (std::size_t i = 4; i < 8; ++i) EXPECT_FALSE(seen[i].sighting.found()) << seen[i].name();
    EXPECT_THAT(seen[4].sighting.reason, HasSubstr("blurred"));
    EXPECT_THAT(seen[5].sighting.reason, HasSubstr("other pictures are 300x210"));
    EXPECT_THAT(seen[6].sighting.reason, HasSubstr("not a picture"));
    EXPECT_THAT(seen[7].sighting.reason, HasSubstr("cut off"));
}

TEST(Pictures, that_do_not_tell_the_layout_of_their_board_have_that_of_the_others) {
    const TemporaryFolder folder;
    BoardPattern pattern = chessboard_pattern("6x7", 0.04);
    pattern.kind = BoardKind::charuco;
    pattern.marker_m = 0.028;
    pattern.dictionary = "5X5_250";
    BoardPattern legacy = pattern;
    legacy.legacy = true;
    GreyImage picture = draw_board(legacy, 40);
    cv::GaussianBlur(picture, picture, {}, 0.8);
    write_grey_image(folder.path() / "whole1.png", picture);
    // Without its right columns the board could be one of the other layout, a square aside.
    picture.colRange(200, picture.cols).setTo(130);
    write_grey_image(folder.path() / "part2.png", picture);
    ASSERT_FALSE(find_board(picture, pattern).layout_is_sure);
    const std::vector<SeenPicture> seen =
        look_at_pictures({folder.path() / "whole1.png", folder.path() / "part2.png"}, pattern);
    ASSERT_TRUE(seen[1].sighting.found()) << seen[1].sighting.reason;
    EXPECT_TRUE(seen[1].sighting.legacy);
    for (const BoardCorner& corner : seen[1].sighting.corners) {
        const Eigen::Vector2d drawn(79.5 + 40 * (corner.id % 6), 79.5 + 40 * (corner.id / 6));
        EXPECT_LT((corner.pixel - drawn).norm(), 0.05);
    }
}

}  // namespace
}  // namespace vantage

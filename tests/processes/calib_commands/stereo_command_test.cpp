#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "common/config/calibration_file.h"
#include "common/image/image_file.h"
#include "tests/support/boards/rendered_stage.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

using testing::HasSubstr;

/// Pairs of a rendered board, filmed once for all tests: seven good ones, then one out of focus,
/// one with a lamp's reflection, one of another size and one that is no picture.
class StereoCommandTest : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        const BoardPattern pattern = chessboard_pattern("9x6", 0.1);
        RenderedStage stage(pattern, 480, 3);
        truth_ = stage.truth(0);
        for (int i = 0; i < 10; ++i) {
            const Pose world_from_board = stage.world_from_board_near(0);
            PictureFaults faults;
            if (i == 7) faults.blur_px = 2.6;
            if (i == 8) faults.glare = 0.55;
            for (const int side : {0, 1}) {
                GreyImage picture = stage.film(0, side, world_from_board, faults);
                if (i == 9) cv::resize(picture, picture, {240, 180});
                write_grey_image(picture_path(side, i), picture);
            }
        }
        for (const int side : {0, 1}) std::ofstream(picture_path(side, 10)) << "no picture";
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static std::filesystem::path picture_path(int side, int i) {
        return folder_->path() / ((side == 0 ? "left" : "right") + std::to_string(i) + ".png");
    }
    static std::string pictures(const std::string& pattern) {
        return (folder_->path() / pattern).string();
    }

    ProgramResult stereo(const std::string& left, const std::string& right,
                         const std::string& board = "9x6") const {
        return run_to_end(VANTAGE_CALIB, {"stereo", "--board", board, "--square-m", "0.1", "--left",
                                          pictures(left), "--right", pictures(right), "--lens",
                                          "brown4", "-o", output_, "--html", html_, "--json"});
    }
    void expect_refusal(const ProgramResult& result, const std::string& words) const {
        EXPECT_EQ(result.status, 1);
        EXPECT_EQ(result.out, "");
        EXPECT_THAT(result.err, HasSubstr(words));
        EXPECT_FALSE(std::filesystem::exists(output_));
        EXPECT_FALSE(std::filesystem::exists(html_));
    }

    static std::unique_ptr<TemporaryFolder> folder_;
    static StereoCalibration truth_;
    TemporaryFolder results_;
    std::string output_ = results_.path() / "rig.yaml", html_ = results_.path() / "rig.html";
};

std::unique_ptr<TemporaryFolder> StereoCommandTest::folder_;
StereoCalibration StereoCommandTest::truth_;

TEST_F(StereoCommandTest, calibrates_a_rig_and_says_of_every_picture_why_it_was_left_out) {
    const ProgramResult result = stereo("left*", "right*");
    ASSERT_EQ(result.status, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("views_given"), 11);
    EXPECT_EQ(json.at("views_used"), 7);
    EXPECT_LT(json.at("rms_px"), 0.05);
    EXPECT_NEAR(json.at("baseline_m"), truth_.right_from_left.translation().norm(), 2e-4);
    EXPECT_NEAR(json.at("left").at("fx"), truth_.left.fx_px, 1.5e-3 * truth_.left.fx_px);
    EXPECT_GT(json.at("left").at("sigma").at("fx"), 0);
    std::map<std::string, std::string> reasons;
    for (const auto& refusal : json.at("rejected"))
        reasons[refusal.at("name")] = refusal.at("reason");
    EXPECT_THAT(reasons["left7.png"], HasSubstr("blurred"));
    EXPECT_THAT(reasons["left8.png"], HasSubstr("glare"));
    EXPECT_THAT(reasons["right9.png"], HasSubstr("240x180"));
    EXPECT_THAT(reasons["right10.png"], HasSubstr("not a picture"));

    const StereoCalibration written = load_calibration(output_);
    EXPECT_EQ(written.left.fx_px, json.at("left").at("fx"));
    const CalibrationRecord record = load_calibration_record(output_);
    ASSERT_TRUE(record.sigma);
    EXPECT_EQ(record.sigma->right.cx_px, json.at("right").at("sigma").at("cx"));
    std::ifstream page(html_);
    const std::string html{std::istreambuf_iterator<char>(page), {}};
    for (const char* part : {"<svg", "Residual of every view", "left8.png", "glare", "k1", "±"})
        EXPECT_THAT(html, HasSubstr(part));
}

TEST_F(StereoCommandTest, gets_the_same_bits_from_pictures_that_hold_both_sides) {
    const auto both = folder_->path() / "both";
    std::filesystem::create_directory(both);
    for (int i = 0; i < 7; ++i) {
        ColourImage picture;
        cv::hconcat(read_colour_image(picture_path(0, i)), read_colour_image(picture_path(1, i)),
                    picture);
        write_colour_image(both / fmt::format("both{}.png", i), picture);
    }
    const ProgramResult two = stereo("left[0-6].png", "right[0-6].png");
    ASSERT_EQ(two.status, 0) << two.err;
    const StereoCalibration of_two = load_calibration(output_);
    const ProgramResult one = run_to_end(
        VANTAGE_CALIB, {"stereo", "--board", "9x6", "--square-m", "0.1", "--side-by-side",
                        (both / "both*.png").string(), "--lens", "brown4", "-o", output_});
    ASSERT_EQ(one.status, 0) << one.err;
    EXPECT_EQ(load_calibration(output_).id, of_two.id);
    // A side is half of a picture.
    const ColourImage odd(180, 481, cv::Vec4b(90, 90, 90, 255));
    write_colour_image(both / "odd.png", odd);
    const ProgramResult refused = run_to_end(
        VANTAGE_CALIB, {"stereo", "--board", "9x6", "--square-m", "0.1", "--side-by-side",
                        (both / "odd.png").string(), "-o", output_ + ".other"});
    EXPECT_EQ(refused.status, 1);
    EXPECT_THAT(refused.err, HasSubstr("481"));
}

TEST_F(StereoCommandTest, names_swapped_sides_and_leaves_nothing_behind) {
    expect_refusal(stereo("right[0-6].png", "left[0-6].png"), "left and right are swapped");
}

TEST_F(StereoCommandTest, names_the_size_of_the_board_that_it_sees) {
    expect_refusal(stereo("left[0-6].png", "right[0-6].png", "8x5"),
                   "a board of 9x6 inner corners, not 8x5");
}

TEST_F(StereoCommandTest, names_pictures_that_are_mirrored_against_each_other) {
    for (int i = 0; i < 7; ++i) {
        ColourImage picture = read_colour_image(picture_path(1, i));
        cv::flip(picture, picture, 1);
        write_colour_image(folder_->path() / ("mirror" + std::to_string(i) + ".png"), picture);
    }
    expect_refusal(stereo("left[0-6].png", "mirror[0-6].png"), "mirrored against each other");
}

TEST_F(StereoCommandTest, keeps_a_good_file_where_it_fails) {
    std::ofstream(output_) << "precious";
    const ProgramResult result = stereo("left[0-1].png", "right[0-1].png");
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("at least 3 are needed"));
    std::ifstream file(output_);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "precious");
}

}  // namespace
}  // namespace vantage

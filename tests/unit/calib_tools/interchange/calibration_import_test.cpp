#include "calib_tools/interchange/calibration_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// A transforms.json of cameras beside each other, so many units apart.
FormFile row_of_cameras(const std::vector<std::string>& names, double apart) {
    Tree frames = Tree::array();
    for (std::size_t i = 0; i < names.size(); ++i)
        frames.push_back(
            {{"file_path", names[i]},
             {"transform_matrix", Tree::array({Tree{1.0, 0.0, 0.0, apart * static_cast<double>(i)},
                                               Tree{0.0, 1.0, 0.0, 0.0}, Tree{0.0, 0.0, 1.0, 0.0},
                                               Tree{0.0, 0.0, 0.0, 1.0}})}});
    const Tree tree{{"w", 320},    {"h", 240},    {"fl_x", 300.0},   {"fl_y", 300.0},
                    {"cx", 160.0}, {"cy", 120.0}, {"frames", frames}};
    return form_file_of("transforms.json", tree.dump());
}

ImportedCalibration imported(const FormFile& file, const ImportSettings& settings = {}) {
    return import_calibration(std::span(&file, 1), settings);
}

std::string refusal(const FormFile& file, const ImportSettings& settings = {}) {
    return thrown_sentence([&] { imported(file, settings); });
}

TEST(CalibrationImport, FindsLeftAndRightByWhereTheyStand) {
    for (const double apart : {0.1, -0.1}) {
        const ImportedCalibration result = imported(row_of_cameras({"a.png", "b.png"}, apart));
        ASSERT_TRUE(result.rig);
        EXPECT_NEAR(result.rig->right_from_left.translation().x(), -0.1, 1e-12);
        EXPECT_THAT(result.taken,
                    Contains(HasSubstr(apart > 0 ? "left: 'a.png'" : "left: 'b.png'")));
        EXPECT_THAT(result.assumed, Contains(HasSubstr("pixel centres")));
        EXPECT_THAT(result.assumed, Contains(HasSubstr("lengths in metres")));
        EXPECT_TRUE(result.rig->place_is_assumed);
        result.rig->validate();
    }
}

TEST(CalibrationImport, AsksWhichOfSeveralCamerasAreTheRig) {
    const FormFile row = row_of_cameras({"1.png", "2.png", "3.png"}, 0.1);
    EXPECT_THAT(refusal(row), HasSubstr("1.png, 2.png, 3.png"));
    const ImportedCalibration result = imported(row, {.left = "1.png", .right = "3.png"});
    EXPECT_NEAR(result.rig->right_from_left.translation().norm(), 0.2, 1e-12);
    EXPECT_THAT(result.left_out, Contains("the camera '2.png'"));
    EXPECT_THAT(refusal(row, {.left = "3.png", .right = "1.png"}), HasSubstr("swap"));
    EXPECT_THAT(refusal(row, {.left = "9.png", .right = "1.png"}), HasSubstr("no camera '9.png'"));
    EXPECT_THAT(refusal(row, {.left = "1.png"}), HasSubstr("both --left and --right"));
    EXPECT_TRUE(imported(row_of_cameras({"up", "my_left", "my_right"}, 0.1)).rig);
    const FormFile paths = row_of_cameras({"./a/L.png", "./a/R1.png", "./a/R12.png"}, 0.1);
    EXPECT_TRUE(imported(paths, {.left = "L.png", .right = "R1.png"}).rig);
    EXPECT_THAT(refusal(paths, {.left = "L.png", .right = "R1"}), HasSubstr("several cameras"));
}

TEST(CalibrationImport, AsksForTheUnitWhereMetresCannotBe) {
    const FormFile row = row_of_cameras({"a", "b"}, 60);
    EXPECT_THAT(refusal(row), HasSubstr("--unit"));
    EXPECT_NEAR(imported(row, {.metres_per_unit = 0.001}).rig->rectified.baseline_m, 0.06, 1e-9);
    EXPECT_NEAR(imported(row, {.baseline_m = 0.075}).rig->rectified.baseline_m, 0.075, 1e-9);
}

TEST(CalibrationImport, TakesASingleCameraAndRefusesWhatIsNone) {
    const ImportedCalibration one = imported(row_of_cameras({"a"}, 0));
    EXPECT_FALSE(one.rig);
    EXPECT_EQ(one.camera.width_px, 320);
    EXPECT_THAT(refusal(form_file_of("a.yaml", "a: 1\n")), HasSubstr("Kalibr"));
    EXPECT_THAT(refusal(row_of_cameras({"a", "b"}, 0)), HasSubstr("0"));
}

TEST(CalibrationImport, TakesAllCamerasWithTheirPlacesIntoAWorldWithYUp) {
    const FormFile row = row_of_cameras({"a 1.png", "a/1.png", "b"}, 600);
    ImportSettings settings;
    settings.metres_per_unit = 0.001;
    const ImportedCameras all = import_cameras(std::span(&row, 1), settings, "z");
    ASSERT_EQ(all.cameras.size(), 3u);
    EXPECT_EQ(all.cameras[0].name, "a_1_png");
    EXPECT_EQ(all.cameras[1].name, "a_1_png_2") << "names are unique";
    const Pose& third = all.cameras[2].world_from_camera;
    EXPECT_NEAR(third.translation().x(), 1.2, 1e-12);
    // The camera looked along -z of the file, so it looks down where z points up.
    EXPECT_TRUE(third.linear().col(2).isApprox(-Eigen::Vector3d::UnitY(), 1e-9));
    const ImportedCameras same = import_cameras(std::span(&row, 1), settings, "y");
    EXPECT_TRUE(same.cameras[2].world_from_camera.linear().col(2).isApprox(
        -Eigen::Vector3d::UnitZ(), 1e-9));
    const ImportedCameras down = import_cameras(std::span(&row, 1), settings, "-y");
    EXPECT_NEAR(down.cameras[0].world_from_camera.linear().determinant(), 1, 1e-9);
    EXPECT_THAT(down.assumed, Contains(HasSubstr("--up")));
}

TEST(CalibrationImport, ChecksTheRowsOfPictures) {
    StereoCalibration rig = *imported(row_of_cameras({"a", "b"}, 0.1)).rig;
    ColourImage left(240, 320);
    cv::RNG random(4);
    cv::Mat3b small(60, 80), large;
    random.fill(small, cv::RNG::UNIFORM, 0, 255);
    cv::resize(small, large, left.size(), 0, 0, cv::INTER_CUBIC);
    cv::cvtColor(large, left, cv::COLOR_RGB2RGBA);
    const auto shifted = [&](double right_px, double down_px) {
        ColourImage picture;
        const cv::Matx23d shift(1, 0, right_px, 0, 1, down_px);
        cv::warpAffine(left, picture, shift, left.size(), cv::INTER_LINEAR, cv::BORDER_REFLECT);
        return picture;
    };
    const RowAgreement good = check_rows(rig, left, shifted(-12, 0));
    EXPECT_GT(good.features, 20u);
    EXPECT_LT(good.median_px, 0.2);
    EXPECT_NEAR(check_rows(rig, left, shifted(-12, 3)).median_px, 3, 0.3);
    // One whole row off, as a decoder may deliver it, is corrected at the right camera.
    const double cy_px = rig.right.cy_px;
    RowAgreement rows = check_rows(rig, left, shifted(-12, 1));
    EXPECT_NEAR(rows.offset_px, 1, 0.1);
    const auto offset_px = correct_row_offset(rig, 0, left, shifted(-12, 1), rows);
    ASSERT_TRUE(offset_px);
    EXPECT_NEAR(*offset_px, 1, 0.1);
    EXPECT_NEAR(rig.right.cy_px, cy_px + 1, 0.1);
    EXPECT_LT(rows.median_px, 0.2);
    EXPECT_FALSE(correct_row_offset(rig, 0, left, shifted(-12, 1), rows)) << "they agree";
    EXPECT_THAT(thrown_sentence([&] { check_rows(rig, left.colRange(0, 100), left); }),
                HasSubstr("100x240"));
}

}  // namespace
}  // namespace vantage

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/config/calibration_file.h"
#include "common/geometry/rectification_map.h"
#include "common/image/image_file.h"
#include "common/rectification/rectify_reference.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

StereoCalibration toed_in_pair() {
    StereoCalibration calibration;
    CameraModel camera;
    camera.width_px = 61;
    camera.height_px = 47;
    camera.fx_px = camera.fy_px = 55;
    camera.cx_px = 29;
    camera.cy_px = 24;
    camera.distortion = {-0.2, 0.05, 0.001, -0.001, 0.0};
    calibration.left = calibration.right = camera;
    calibration.right_from_left.linear() =
        Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY()).toRotationMatrix();
    calibration.right_from_left.translation() = Eigen::Vector3d(-0.1, 0, 0);
    compute_rectification(calibration, 0);
    return calibration;
}

ColourImage noise(int width_px, int height_px, std::uint64_t seed) {
    ColourImage picture(height_px, width_px);
    cv::RNG(seed).fill(picture, cv::RNG::UNIFORM, 0, 256);
    for (cv::Vec4b& c : picture) c[3] = 255;
    return picture;
}

class RectifyCommandTest : public testing::Test {
  protected:
    RectifyCommandTest() {
        save_calibration(calibration_, toed_in_pair(), {"2026-01-01", "test", 0.2, 0.1, 9});
        write_colour_image(left_, noise(61, 47, 1));
        write_colour_image(right_, noise(61, 47, 2));
    }

    std::string path(const char* name) const { return folder_.path() / name; }

    ProgramResult rectify(const std::string& calibration, const std::string& left,
                          const std::string& right, const std::string& out_left,
                          const std::string& out_right) {
        return run_to_end(VANTAGE_CALIB,
                          {"rectify", "--calibration", calibration, left, right, "--out-left",
                           out_left, "--out-right", out_right, "--json"});
    }

    void expect_refusal(const ProgramResult& result, const std::string& word) {
        EXPECT_EQ(result.status, 1);
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(out_left_));
        EXPECT_FALSE(std::filesystem::exists(out_right_));
    }

    TemporaryFolder folder_;
    std::string calibration_ = path("calib.yaml"), left_ = path("left.png"),
                right_ = path("right.png"), out_left_ = path("out-left.png"),
                out_right_ = path("out-right.png");
};

TEST_F(RectifyCommandTest, WritesWhatTheReferenceComputesForBothSides) {
    const ProgramResult result = rectify(calibration_, left_, right_, out_left_, out_right_);
    ASSERT_EQ(result.status, 0) << result.err;
    const StereoCalibration calibration = load_calibration(calibration_);
    EXPECT_EQ(cv::norm(read_colour_image(out_left_),
                       rectify_reference(noise(61, 47, 1),
                                         make_rectification_map(calibration, Side::left)),
                       cv::NORM_INF),
              0);
    EXPECT_EQ(cv::norm(read_colour_image(out_right_),
                       rectify_reference(noise(61, 47, 2),
                                         make_rectification_map(calibration, Side::right)),
                       cv::NORM_INF),
              0);
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("calibration"), calibration.id);
    EXPECT_EQ(json.at("width"), calibration.rectified.width_px);
    EXPECT_NEAR(json.at("baseline_m"), 0.1, 1e-9);
}

TEST_F(RectifyCommandTest, RefusesPicturesOfAnotherSizeThanTheCalibration) {
    const std::string wide = path("wide.png");
    write_colour_image(wide, noise(64, 47, 3));
    expect_refusal(rectify(calibration_, left_, wide, out_left_, out_right_), "64x47");
}

TEST_F(RectifyCommandTest, RefusesWhatIsMissingOrDamaged) {
    expect_refusal(rectify(path("none.yaml"), left_, right_, out_left_, out_right_), "none.yaml");
    expect_refusal(rectify(calibration_, path("none.png"), right_, out_left_, out_right_),
                   "none.png");
    const std::string damaged = path("damaged.yaml");
    std::ofstream(damaged) << "%YAML:1.0\n---\nversion: [";
    expect_refusal(rectify(damaged, left_, right_, out_left_, out_right_), "damaged.yaml");
}

TEST_F(RectifyCommandTest, RefusesOutputsThatWouldBeLostOrLoseAnInput) {
    expect_refusal(rectify(calibration_, left_, right_, out_left_, out_left_), "out-left.png");
    expect_refusal(rectify(calibration_, left_, right_, left_, out_right_), "left.png");
    expect_refusal(rectify(calibration_, left_, right_, out_left_, path("missing/r.png")),
                   "missing/r.png");
    EXPECT_EQ(cv::norm(read_colour_image(left_), noise(61, 47, 1), cv::NORM_INF), 0);
}

}  // namespace
}  // namespace vantage

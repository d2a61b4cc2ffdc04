#include "common/config/intrinsics_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/support/thrown_sentence.h"
#include "tests/unit/common/config/saved_file.h"

namespace vantage {
namespace {

class IntrinsicsFileTest : public SavedFile {
  protected:
    IntrinsicsFileTest() : SavedFile("left.yaml") {}

    void save() const { save_intrinsics(file_, camera_, record_); }
    std::string fault() const {
        return thrown_sentence([this] { load_intrinsics(file_); });
    }

    CameraModel camera_{.width_px = 641,
                        .height_px = 479,
                        .fx_px = 533.1 / 3,
                        .fy_px = 532.7,
                        .cx_px = 320.4,
                        .cy_px = 239.9,
                        .skew_px = 0,
                        .distortion = {-0.29, 0.1, 1e-4, -2.0 / 3e5, 0.05}};
    IntrinsicsRecord record_{.date = "2026-11-21T10:00:00Z",
                             .tool = "a test",
                             .rms_px = 0.25,
                             .views_used = 12,
                             .sigma = {.fx_px = 0.5,
                                       .fy_px = 0.25,
                                       .cx_px = 1,
                                       .cy_px = 2,
                                       .distortion = {0.1, 0.2, 0.3, 0.4, 0.5}}};
};

TEST_F(IntrinsicsFileTest, RoundTripsEveryBit) {
    save();
    const CameraModel read = load_intrinsics(file_);
    EXPECT_EQ(read.width_px, camera_.width_px);
    EXPECT_EQ(read.height_px, camera_.height_px);
    EXPECT_EQ(read.lens, camera_.lens);
    EXPECT_EQ(read.K(), camera_.K());
    EXPECT_EQ(read.distortion, camera_.distortion);
}

TEST_F(IntrinsicsFileTest, StoresUncertaintiesUnderOpenCvsNames) {
    save();
    const cv::FileStorage file(file_.string(), cv::FileStorage::READ);
    cv::Mat K;
    file["camera_matrix"] >> K;
    EXPECT_EQ(K.at<double>(1, 1), camera_.fy_px);
    EXPECT_EQ(static_cast<double>(file["avg_reprojection_error"]), 0.25);
    EXPECT_EQ(static_cast<double>(file["sigma"]["cy_px"]), 2);
}

TEST_F(IntrinsicsFileTest, RefusesAChangedNumber) {
    save();
    replace("image_width: 641", "image_width: 642");
    EXPECT_THAT(fault(),
                testing::AllOf(testing::HasSubstr("left.yaml: the checksum does not match"),
                               testing::HasSubstr("last good file")));
}

TEST_F(IntrinsicsFileTest, RefusesAChangedUncertainty) {
    save();
    replace("cy_px: 2.", "cy_px: 3.");
    EXPECT_THAT(fault(), testing::HasSubstr("the checksum does not match"));
}

TEST_F(IntrinsicsFileTest, NamesMissingAndInvalidValues) {
    save();
    replace("cy_px: 2.", "cy_px: -2.");
    EXPECT_THAT(fault(), testing::HasSubstr("'sigma.cy_px' is -2, but a deviation is 0 or more"));
    save();
    replace("camera_matrix", "camera_nothing");
    EXPECT_THAT(fault(), testing::HasSubstr("'camera_matrix' is missing"));
    save();
    replace("camera intrinsics", "stereo calibration");
    EXPECT_THAT(fault(), testing::HasSubstr("this is not the lens of a camera"));
}

TEST_F(IntrinsicsFileTest, KeepsTheLastGoodFile) {
    save();
    camera_.fx_px += 1;
    save();
    EXPECT_EQ(load_intrinsics(file_.string() + ".last").fx_px, camera_.fx_px - 1);
    replace("image_width: 641", "image_width: 642");
    camera_.fx_px += 1;
    save();
    EXPECT_EQ(load_intrinsics(file_.string() + ".last").fx_px, camera_.fx_px - 2)
        << "a damaged file took the place of a good one";
}

TEST_F(IntrinsicsFileTest, RefusesToWriteAnInvalidCamera) {
    save();
    camera_.fx_px = -1;
    EXPECT_NE(thrown_sentence([this] { save(); }), "");
    EXPECT_EQ(load_intrinsics(file_).fx_px, 533.1 / 3);
}

}  // namespace
}  // namespace vantage

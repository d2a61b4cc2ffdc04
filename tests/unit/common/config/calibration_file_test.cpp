#include "common/config/calibration_file.h"

#include <fstream>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/support/thrown_sentence.h"
#include "tests/unit/common/config/saved_file.h"

namespace vantage {
namespace {

StereoCalibration odd_calibration() {
    StereoCalibration c;
    c.left = {.width_px = 641,
              .height_px = 479,
              .fx_px = 533.1 / 3,
              .fy_px = 532.7,
              .cx_px = 320.4,
              .cy_px = 239.9,
              .skew_px = 0.01,
              .distortion = {-0.29, 0.1, 1e-4, -2.0 / 3e5, 0.05}};
    c.right = c.left;
    c.right.cx_px += std::numbers::pi;
    c.right.distortion = {};
    c.right_from_left.translation() = Eigen::Vector3d(-0.1, 0.001, 1.0 / 3000);
    c.right_from_left.linear() =
        Eigen::AngleAxisd(0.02, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    c.rectified = {.width_px = 641,
                   .height_px = 479,
                   .f_px = 500.25,
                   .cx_left_px = 300,
                   .cx_right_px = 301.5,
                   .cy_px = 240,
                   .baseline_m = 0.1};
    c.rectified_from_left = Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitY()).toRotationMatrix();
    c.world_from_left.translation() = Eigen::Vector3d(1, 2, -3);
    c.world_from_left.linear() = Eigen::AngleAxisd(1, Eigen::Vector3d::UnitX()).toRotationMatrix();
    return c;
}

class CalibrationFileTest : public SavedFile {
  protected:
    CalibrationFileTest() : SavedFile("calib.yaml") {}

    std::string fault() const {
        std::string sentence = thrown_sentence([&] { load_calibration(file_); });
        const std::string prefix = file_.string() + ": ";
        if (sentence.starts_with(prefix)) sentence.erase(0, prefix.size());
        return sentence;
    }
    void save(const StereoCalibration& c = odd_calibration()) {
        save_calibration(file_, c, record_);
    }

    CalibrationRecord record_ = {.date = "2026-01-02T03:04:05Z",
                                 .tool = "vantage-calib \"stereo\" 1",
                                 .rms_px = 0.21,
                                 .row_rms_px = 0.14,
                                 .views_used = 13};
};

TEST_F(CalibrationFileTest, RoundTripsEveryBit) {
    const StereoCalibration saved = odd_calibration();
    save(saved);
    const StereoCalibration loaded = load_calibration(file_);
    EXPECT_EQ(loaded.left.K(), saved.left.K());
    EXPECT_EQ(loaded.right.K(), saved.right.K());
    EXPECT_EQ(loaded.left.width_px, 641);
    EXPECT_EQ(loaded.left.height_px, 479);
    EXPECT_EQ(loaded.left.distortion, saved.left.distortion);
    EXPECT_TRUE(loaded.right.distortion.empty());
    EXPECT_EQ(loaded.right_from_left.matrix(), saved.right_from_left.matrix());
    EXPECT_EQ(loaded.world_from_left.matrix(), saved.world_from_left.matrix());
    EXPECT_EQ(loaded.rectified_from_left, saved.rectified_from_left);
    EXPECT_EQ(loaded.rectified_from_right, saved.rectified_from_right);
    EXPECT_EQ(loaded.rectified.width_px, 641);
    EXPECT_EQ(loaded.rectified.height_px, 479);
    EXPECT_EQ(loaded.rectified.f_px, saved.rectified.f_px);
    EXPECT_EQ(loaded.rectified.doffs_px(), 1.5);
    EXPECT_EQ(loaded.rectified.cy_px, saved.rectified.cy_px);
    EXPECT_EQ(loaded.rectified.baseline_m, saved.rectified.baseline_m);
    EXPECT_EQ(loaded.id, calibration_checksum(saved));
    EXPECT_EQ(loaded.id.size(), 16u);
}

TEST_F(CalibrationFileTest, RoundTripsItsRecordAndAFisheyeLens) {
    StereoCalibration c = odd_calibration();
    c.left.lens = c.right.lens = LensModel::fisheye;
    c.left.distortion = {0.1, 0.2, 0.3, 0.4};
    save(c);
    EXPECT_EQ(load_calibration(file_).left.lens, LensModel::fisheye);
    const CalibrationRecord record = load_calibration_record(file_);
    EXPECT_EQ(record.date, record_.date);
    EXPECT_EQ(record.tool, record_.tool);
    EXPECT_EQ(record.rms_px, record_.rms_px);
    EXPECT_EQ(record.row_rms_px, record_.row_rms_px);
    EXPECT_EQ(record.views_used, record_.views_used);
}

TEST_F(CalibrationFileTest, RoundTripsUncertaintiesAndRefusesInvalidOnes) {
    const StereoCalibration c = odd_calibration();
    CalibrationSigma sigma;
    sigma.left = {0.25, 0.5, 0.125, 0.75, std::vector<double>(c.left.distortion.size(), 0.01)};
    sigma.right = {1, 2, 3, 4, std::vector<double>(c.right.distortion.size(), 0.02)};
    sigma.rotation_rad = {1e-4, 2e-4, 3e-4};
    sigma.translation_m = {0.001, 0.002, 0.003};
    record_.alpha = 0.5;
    save();
    EXPECT_FALSE(load_calibration_record(file_).sigma);
    record_.sigma = sigma;
    save();
    const CalibrationRecord record = load_calibration_record(file_);
    EXPECT_EQ(record.alpha, 0.5);
    ASSERT_TRUE(record.sigma);
    EXPECT_EQ(record.sigma->left.fy_px, 0.5);
    EXPECT_EQ(record.sigma->left.distortion, sigma.left.distortion);
    EXPECT_EQ(record.sigma->right.cy_px, 4);
    EXPECT_EQ(record.sigma->rotation_rad, sigma.rotation_rad);
    EXPECT_EQ(record.sigma->translation_m, sigma.translation_m);
    set_number("fx_px", "-0.25");
    EXPECT_THAT(thrown_sentence([&] { load_calibration_record(file_); }),
                testing::HasSubstr("'sigma.left.fx_px' is -0.25"));
}

TEST_F(CalibrationFileTest, IsReadByOpenCvAlone) {
    save();
    const cv::FileStorage file(file_.string(), cv::FileStorage::READ);
    cv::Mat K, distortion;
    file["left"]["K"] >> K;
    file["left"]["distortion"] >> distortion;
    EXPECT_EQ(K.at<double>(0, 0), 533.1 / 3);
    EXPECT_EQ(distortion.total(), 5u);
    EXPECT_NE(static_cast<std::string>(file["units"]).find("metres"), std::string::npos);
}

TEST(CalibrationChecksum, DependsOnEveryNumberAndOnNothingElse) {
    const StereoCalibration c = odd_calibration();
    StereoCalibration renamed = c;
    renamed.id = "other";
    EXPECT_EQ(calibration_checksum(c), calibration_checksum(renamed));
    std::vector<StereoCalibration> changed(8, c);
    changed[0].left.fx_px += 1e-9;
    changed[1].right.distortion = {0, 0, 0, 0};
    changed[2].right_from_left.translation().x() -= 1e-12;
    changed[3].rectified_from_right(0, 1) += 1e-15;
    changed[4].world_from_left.translation().z() += 1e-9;
    changed[5].rectified.cx_right_px += 1e-9;
    changed[6].left.height_px += 1;
    changed[7].left.lens = LensModel::fisheye;
    for (const StereoCalibration& other : changed)
        EXPECT_NE(calibration_checksum(c), calibration_checksum(other));
}

TEST_F(CalibrationFileTest, KeepsTheLastGoodFile) {
    save();
    const std::string first_id = load_calibration(file_).id;
    StereoCalibration second = odd_calibration();
    second.left.fx_px = 600;
    save(second);
    const std::filesystem::path last = file_.string() + ".last";
    EXPECT_EQ(load_calibration(last).id, first_id);
    std::ofstream(file_) << "damaged";
    save(second);
    EXPECT_EQ(load_calibration(last).id, first_id) << "a damaged file must not replace a good one";
    EXPECT_EQ(load_calibration(file_).id, calibration_checksum(second));
}

TEST_F(CalibrationFileTest, RefusesToWriteAnInvalidCalibration) {
    save();
    const std::string before = text();
    StereoCalibration bad = odd_calibration();
    bad.rectified.baseline_m = -0.1;
    EXPECT_THROW(save(bad), Error);
    EXPECT_EQ(text(), before);
    EXPECT_THROW(save_calibration(folder_.path() / "none" / "c.yaml", odd_calibration(), record_),
                 Error);
}

TEST_F(CalibrationFileTest, RefusesAChangedNumber) {
    save();
    replace("width_px: 641", "width_px: 642");
    EXPECT_TRUE(fault().starts_with("the checksum does not match the numbers")) << fault();
}

TEST_F(CalibrationFileTest, RefusesChangedResidualsAndChangedOrMissingUncertainties) {
    const StereoCalibration c = odd_calibration();
    record_.sigma = CalibrationSigma{
        {0.25, 0.5, 0.125, 0.75, std::vector<double>(c.left.distortion.size(), 0.01)},
        {1, 2, 3, 4, std::vector<double>(c.right.distortion.size(), 0.02)}};
    record_.alpha = 0.5;
    constexpr std::string_view contradiction = "the checksum does not match the numbers";
    for (const auto& [key, value] :
         {std::pair("fx_px", "0.26"), std::pair("row_rms_px", "0.13"), std::pair("alpha", "0.6")}) {
        save();
        set_number(key, value);
        EXPECT_TRUE(fault().starts_with(contradiction)) << key << fault();
    }
    save();
    replace("\nsigma:", "\nsigmas:");
    EXPECT_TRUE(fault().starts_with(contradiction)) << fault();
}

TEST_F(CalibrationFileTest, RecordsWhetherItsPoseIsAssumed) {
    save();
    EXPECT_FALSE(load_calibration(file_).place_is_assumed);
    StereoCalibration c = odd_calibration();
    assume_place(c);
    save(c);
    const StereoCalibration loaded = load_calibration(file_);
    EXPECT_TRUE(loaded.place_is_assumed);
    EXPECT_EQ(loaded.world_from_left.matrix(), c.world_from_left.matrix());
}

/// What version 1 wrote: the geometry's checksum, and the identity for a place that nobody knew.
TEST_F(CalibrationFileTest, ReadsVersion1AndAssumesALevelPoseWithoutOne) {
    StereoCalibration c = odd_calibration();
    c.world_from_left = Pose::Identity();
    for (const char* tool : {"vantage-calib stereo", "vantage-calib stage"}) {
        record_.tool = tool;
        save(c);
        std::string old = text();
        const auto set = [&old](const std::string& key, const std::string& value) {
            const std::size_t at = old.find("\n" + key + ":") + 1;
            old.replace(at, old.find('\n', at) - at, value);
        };
        set("version", "version: 1");
        set("checksum", "checksum: \"fnv1a64:" + calibration_checksum(c) + "\"");
        set("place_is_assumed", "");
        std::ofstream(file_) << old;
        const StereoCalibration loaded = load_calibration(file_);
        const bool is_placed = std::string(tool) == "vantage-calib stage";
        EXPECT_EQ(loaded.place_is_assumed, !is_placed);
        EXPECT_EQ(loaded.id, calibration_checksum(c));
        EXPECT_EQ(loaded.world_from_left.matrix() == Pose::Identity().matrix(), is_placed);
    }
}

TEST_F(CalibrationFileTest, RefusesAnotherVersionOrKind) {
    save();
    replace("version: 2", "version: 3");
    EXPECT_EQ(fault(), "it has version 3, but this program reads versions 1 to 2");
    replace("version: 3", "version: 2");
    replace("vantage stereo calibration", "shopping list");
    EXPECT_EQ(fault(), "this is not a calibration of Vantage");
}

TEST_F(CalibrationFileTest, NamesMissingKeysAndWrongTypes) {
    save();
    replace("baseline_m:", "baseline:");
    EXPECT_EQ(fault(), "'rectified.baseline_m' is missing");
    save();
    replace("f_px: ", "f_px: about ");
    EXPECT_EQ(fault(), "'rectified.f_px' must be a number");
    save();
    replace("height_px: 479", "height_px: 479.5");
    EXPECT_EQ(fault(), "'left.height_px' must be an integer");
    save();
    replace("lens: pinhole", "lens: mirror");
    EXPECT_EQ(fault(), "'left.lens' is 'mirror', but must be pinhole or fisheye");
    save();
    replace("rows: 3", "rows: 2000000000");
    EXPECT_EQ(fault(), "'left.K' is 2000000000x3 and holds 9 numbers");
}

TEST_F(CalibrationFileTest, RefusesInvalidNumbers) {
    save();
    replace("baseline_m: ", "baseline_m: -");
    EXPECT_TRUE(fault().starts_with("baseline -0.1 m must be above 0")) << fault();
    save();
    replace("width_px: 641", "width_px: 0");
    EXPECT_TRUE(fault().starts_with("camera size 0x479")) << fault();
}

TEST_F(CalibrationFileTest, RefusesFilesThatAreNotYaml) {
    EXPECT_NE(fault(), "") << "a missing file";
    for (const std::string& content :
         {std::string(), std::string("\0\x01\x02", 3), std::string("%YAML:1.0\n---\n{{{{"),
          std::string("<?xml version=\"1.0\"?><a/>"), std::string("{\"kind\": 3}"),
          std::string("%YAML:1.0\n---\n- 1\n- 2\n"), std::string("%YAML:1.0\n---\n   : 1.0\n"),
          std::string("%YAML:1.0\n---%YAML:1.0\n\nf\x17---\nf_\0", 30),
          std::string(2 << 20, 'x')}) {
        std::ofstream(file_, std::ios::binary) << content;
        EXPECT_NE(fault(), "") << content.substr(0, 30);
    }
    save();
    const std::string whole = text();
    for (std::size_t length = 0; length < whole.size() - 200; length += 97) {
        std::ofstream(file_, std::ios::binary) << whole.substr(0, length);
        EXPECT_NE(fault(), "") << "truncated to " << length;
    }
}

}  // namespace
}  // namespace vantage

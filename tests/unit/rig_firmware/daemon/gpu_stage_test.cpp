#include "rig_firmware/daemon/gpu_stage.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/base/error.h"
#include "common/rectification/rectify_reference.h"
#include "rig_firmware/capture/rig_calibration.h"

namespace vantage {
namespace {

constexpr int width = 61, height = 47;

class GpuStageTest : public testing::Test {
  protected:
    GpuStageTest() {
        config_.source.width_px = width;
        config_.source.height_px = height;
        config_.match.disparities = 16;
        config_.match.matcher = "gradient";
        cv::RNG random(3);
        ColourImage wide(height, width + 5);
        random.fill(wide, cv::RNG::UNIFORM, 0, 255);
        cv::GaussianBlur(wide, wide, {5, 5}, 1.5);
        for (cv::Vec4b& pixel : wide) pixel[3] = 255;  // raw pictures are opaque
        frame_.left = wide.colRange(0, width).clone();
        frame_.right = wide.colRange(5, width + 5).clone();
        frame_.trigger_index = 77;
        frame_.synchronized = true;
    }

    RigConfig config_;
    StereoFrame frame_;
};

TEST_F(GpuStageTest, MatchesRectifiedPicturesAsTheyAre) {
    const StereoCalibration calibration = ideal_rig(config_, {width, height});
    GpuStage gpu(config_, calibration);
    const RigFrame result = gpu.process(frame_);
    EXPECT_EQ(cv::norm(result.colour, frame_.left, cv::NORM_INF), 0);
    ASSERT_EQ(result.disparity.size(), cv::Size(width, height));
    const DisparityImage inner = result.disparity(cv::Rect(20, 8, 30, 30));
    const cv::Mat near =
        (inner >= 4.5 * disparity_steps_per_px) & (inner <= 5.5 * disparity_steps_per_px);
    EXPECT_GT(cv::countNonZero(near), 0.9 * 30 * 30) << "the right picture is 5 px to the left";
    EXPECT_EQ(result.trigger_index, 77u);
    EXPECT_TRUE(result.synchronized);
    EXPECT_EQ(result.calibration_id, calibration.id);
    EXPECT_EQ(result.geometry.width_px, width);
    EXPECT_TRUE(result.world_from_camera.isApprox(calibration.world_from_left));
    EXPECT_FALSE(gpu.report().empty());
}

/// The right picture is 5 px to the left in the colour's pixels, whatever is matched.
TEST_F(GpuStageTest, MatchesSmallerPicturesAndKeepsTheColour) {
    constexpr int matched_width = 48, matched_height = 37;
    config_.match.width_px = matched_width;
    const StereoCalibration calibration = ideal_rig(config_, {width, height});
    GpuStage gpu(config_, calibration);
    const RigFrame result = gpu.process(frame_);
    EXPECT_EQ(cv::norm(result.colour, frame_.left, cv::NORM_INF), 0);
    EXPECT_EQ(result.geometry.width_px, width);
    ASSERT_EQ(result.disparity.size(), cv::Size(matched_width, matched_height));
    const DisparityImage inner = result.disparity(cv::Rect(16, 7, 24, 24));
    constexpr double expected = 5.0 * matched_width / width * disparity_steps_per_px,
                     tolerance = 0.5 * disparity_steps_per_px;
    const cv::Mat near = (inner >= expected - tolerance) & (inner <= expected + tolerance);
    EXPECT_GT(cv::countNonZero(near), 0.9 * 24 * 24);
}

TEST_F(GpuStageTest, NamesAMatchedWidthThatCannotBe) {
    config_.match.width_px = width + 1;
    const StereoCalibration calibration = ideal_rig(config_, {width, height});
    const auto fault = [&] {
        try {
            require_matching(config_, calibration);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("none");
    };
    EXPECT_EQ(fault(),
              "'width_px' in [match] is 62, and the rectified picture is 61 px wide: matching more "
              "pixels than there are finds nothing; take at most 61");
    config_.match.width_px = 48;
    config_.match.matcher = exact_matcher;
    EXPECT_EQ(fault(),
              "'width_px' in [match] is 48, and the exact disparity has the size of the picture: "
              "leave it out or name a real matcher");
}

/// Pictures that drivers are warmed up with are no part of the stream, however dark that is.
TEST_F(GpuStageTest, GivesAStillDarkPairTheSameDisparityFromTheFirstFrameOn) {
    config_.match.matcher.clear();
    constexpr double dark = 1.0 / 12;  // some within the noise of black, some not
    for (ColourImage* side : {&frame_.left, &frame_.right}) {
        side->convertTo(*side, -1, dark);
        for (cv::Vec4b& pixel : *side) pixel[3] = 255;
    }
    GpuStage gpu(config_, ideal_rig(config_, {width, height}));
    const DisparityImage first = gpu.process(frame_).disparity;
    ASSERT_GT(cv::countNonZero(first), width * height / 2);
    for (int i = 0; i < 5; ++i)
        EXPECT_EQ(cv::norm(gpu.process(frame_).disparity, first, cv::NORM_L1), 0) << i;
}

TEST_F(GpuStageTest, PacksTheColourOfEveryFrameAsThePublisherWould) {
    GpuStage gpu(config_, ideal_rig(config_, {width, height}));
    for (int i = 0; i < 3; ++i) {
        RigFrame result = gpu.process(frame_);
        const std::vector<std::byte> ahead = result.packed_colour;
        result.packed_colour.clear();
        result.rig = "rig";
        result.session = 1;
        EXPECT_EQ(FrameEncoder(config_.stream.jpeg_quality, parse_chroma(config_.stream.chroma))
                      .encode(result)
                      .colour,
                  ahead);
        EXPECT_GT(result.times.pack_ms, 0);
        cv::bitwise_not(frame_.left, frame_.left);
        cv::bitwise_not(frame_.right, frame_.right);
        for (ColourImage* side : {&frame_.left, &frame_.right})
            for (cv::Vec4b& pixel : *side) pixel[3] = 255;
        frame_.left = frame_.left.clone();
    }
}

TEST_F(GpuStageTest, SendsTheRightPictureTwiceASecond) {
    StereoCalibration calibration = ideal_rig(config_, {width, height});
    calibration.left.distortion = calibration.right.distortion = {-0.2, 0.05, 0, 0};
    GpuStage gpu(config_, calibration);
    const ColourImage expected =
        rectify_reference(frame_.right, make_rectification_map(calibration, Side::right));
    std::vector<int> with_right;
    for (int frame = 0; frame < 30; ++frame) {
        frame_.exposure += std::chrono::milliseconds(40);
        const RigFrame result = gpu.process(frame_);
        EXPECT_EQ(result.right.empty(), result.packed_right_bytes == 0);
        if (result.right.empty()) continue;
        with_right.push_back(frame);
        EXPECT_EQ(cv::norm(result.right, expected, cv::NORM_INF), 0);
    }
    EXPECT_EQ(with_right, (std::vector<int>{0, 13, 26}));
    frame_.exposure -= std::chrono::hours(1);  // the clock was set
    EXPECT_FALSE(gpu.process(frame_).right.empty());
}

TEST_F(GpuStageTest, SendsNoRightPictureBesideLosslessColour) {
    config_.stream.jpeg_quality = 0;
    GpuStage gpu(config_, ideal_rig(config_, {width, height}));
    EXPECT_TRUE(gpu.process(frame_).right.empty());
}

TEST_F(GpuStageTest, EveryFrameHasItsOwnColourAndDisparity) {
    StereoCalibration calibration = ideal_rig(config_, {width, height});
    calibration.left.distortion = calibration.right.distortion = {-0.2, 0.05, 0, 0};
    GpuStage gpu(config_, calibration);
    const RigFrame first = gpu.process(frame_);
    StereoFrame dark = frame_;
    dark.left = ColourImage(height, width, cv::Vec4b(0, 0, 0, 255));
    dark.right = dark.left;
    const RigFrame second = gpu.process(dark);
    EXPECT_GT(cv::norm(first.colour, second.colour, cv::NORM_INF), 100);
    for (const cv::Vec4b& pixel : second.colour) ASSERT_EQ(pixel[0] + pixel[1] + pixel[2], 0);
    const RigFrame again = gpu.process(frame_);
    EXPECT_EQ(cv::norm(first.colour, again.colour, cv::NORM_INF), 0);
}

TEST_F(GpuStageTest, RectifiesWhatIsNot) {
    StereoCalibration calibration = ideal_rig(config_, {width, height});
    calibration.left.distortion = calibration.right.distortion = {-0.2, 0.05, 0, 0};
    config_.match.matcher = exact_matcher;
    frame_.exact_disparity = DisparityImage(height, width, std::uint16_t{96});
    GpuStage gpu(config_, calibration);
    const RigFrame result = gpu.process(frame_);
    const ColourImage expected =
        rectify_reference(frame_.left, make_rectification_map(calibration, Side::left));
    EXPECT_EQ(cv::norm(result.colour, expected, cv::NORM_INF), 0);
    EXPECT_GT(cv::norm(result.colour, frame_.left, cv::NORM_INF), 20);
    EXPECT_EQ(cv::countNonZero(result.disparity != 96), 0);
}

TEST_F(GpuStageTest, TellsOfEveryShaderThatItCompilesAndOfNoneLater) {
    config_.match.matcher.clear();
    std::vector<std::pair<int, int>> told;
    GpuStage gpu(config_, ideal_rig(config_, {width, height}), {},
                 [&](const ProgramProgress& progress) {
                     told.emplace_back(progress.used, progress.made);
                     EXPECT_FALSE(progress.file.empty());
                 });
    ASSERT_FALSE(told.empty());
    EXPECT_EQ(told.front(), std::pair(0, 1));
    EXPECT_GT(told.back().first, 5) << "the dark frame uses the programs of a real one";
    EXPECT_LE(told.back().first, told.back().second);
    EXPECT_TRUE(std::ranges::is_sorted(told));
    const std::size_t count = told.size();
    gpu.process(frame_);
    EXPECT_EQ(told.size(), count);
}

TEST_F(GpuStageTest, TheAutomaticPresetIsTheBestThatHoldsTheRate) {
    config_.match.matcher.clear();
    config_.match.preset = "auto";
    const auto chosen = [&](double rate_hz) {
        config_.source.rate_hz = rate_hz;
        const GpuStage gpu(config_, ideal_rig(config_, {width, height}));
        for (const std::string& line : gpu.report())
            if (line.starts_with("preset auto")) return line;
        return std::string();
    };
    EXPECT_THAT(chosen(1e-3), testing::HasSubstr("preset auto: quality"));
    EXPECT_THAT(chosen(1e9), testing::AllOf(testing::HasSubstr("preset auto: fast"),
                                            testing::HasSubstr("no preset holds this rate")));
}

TEST_F(GpuStageTest, TakesExactDisparityOnlyWhereThereIsSome) {
    config_.match.matcher = exact_matcher;
    const StereoCalibration calibration = ideal_rig(config_, {width, height});
    GpuStage gpu(config_, calibration);
    EXPECT_THROW(gpu.process(frame_), Error);
    config_.source.kind = "files";
    EXPECT_THROW(GpuStage(config_, calibration), Error);
}

}  // namespace
}  // namespace vantage

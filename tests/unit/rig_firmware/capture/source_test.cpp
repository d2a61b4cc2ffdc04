#include <thread>

#include <gtest/gtest.h>

#include "common/base/time/pulse_grid.h"
#include "common/config/calibration_file.h"
#include "common/config/rig_config.h"
#include "common/gl/context/egl_context.h"
#include "common/image/image_file.h"
#include "common/virtual_stage/virtual_rig.h"
#include "rig_firmware/capture/rig_calibration.h"
#include "rig_firmware/capture/stereo_source.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

RigConfig small_virtual_rig() {
    RigConfig config;
    config.name = "test";
    config.source.width_px = 61;
    config.source.height_px = 47;
    config.source.rate_hz = 20;
    return config;
}

std::optional<StereoFrame> next_frame(StereoSource& source) {
    for (int tries = 0; tries < 1000 && !source.ended(); ++tries)
        if (auto frame = source.next(50ms)) return frame;
    return std::nullopt;
}

TEST(VirtualSource, FilmsThePulsesOfTheStageInOrder) {
    RigConfig config = small_virtual_rig();
    config.match.matcher = exact_matcher;
    const auto source = make_source(config);
    EXPECT_EQ(source->size(), cv::Size(61, 47));
    EXPECT_FALSE(source->report().empty());
    const PulseGrid grid(20);
    const auto first = next_frame(*source), second = next_frame(*source);
    ASSERT_TRUE(first && second);
    EXPECT_TRUE(first->synchronized);
    EXPECT_EQ(first->exposure, grid.time_of(first->trigger_index));
    EXPECT_EQ(second->exposure, grid.time_of(second->trigger_index));
    EXPECT_EQ(second->trigger_index, first->trigger_index + 1 + source->missed());
    EXPECT_EQ(first->left.size(), source->size());
    EXPECT_EQ(first->right.size(), source->size());
    EXPECT_EQ(first->exact_disparity.size(), source->size());
    EXPECT_GT(cv::countNonZero(first->exact_disparity), 61 * 47 / 2);
    EXPECT_GT(cv::norm(first->left, first->right, cv::NORM_L1), 0);
}

TEST(VirtualSource, LeavesOutTheExactDisparityThatNobodyAsksFor) {
    const auto frame = next_frame(*make_source(small_virtual_rig()));
    ASSERT_TRUE(frame);
    EXPECT_TRUE(frame->exact_disparity.empty());
}

TEST(VirtualSource, FilmsTheSetThatIsAskedFor) {
    RigConfig config = small_virtual_rig();
    const auto of_the_show = next_frame(*make_source(config));
    config.virtual_rig.scene = 3;
    const auto of_set_3 = next_frame(*make_source(config)),
               again = next_frame(*make_source(config));
    ASSERT_TRUE(of_the_show && of_set_3 && again);
    // The walls, above the performers' heads.
    const auto difference = [](const StereoFrame& a, const StereoFrame& b) {
        const cv::Range top(0, 5);
        return cv::norm(a.left.rowRange(top), b.left.rowRange(top), cv::NORM_L1) / (5 * 61);
    };
    EXPECT_GT(difference(*of_the_show, *of_set_3), 30);
    EXPECT_LT(difference(*again, *of_set_3), 3);
    // And all of the picture is that set's.
    const EglContext context;
    const ShaderLibrary shaders;
    VirtualStage stage(shaders, 3);
    const VirtualStereoFrame drawn = render_virtual_rig(
        stage, rig_calibration(config, {config.source.width_px, config.source.height_px}),
        of_set_3->exposure.time_since_epoch(), of_set_3->trigger_index,
        {config.source.noise_sigma, config.source.seed});
    EXPECT_EQ(cv::norm(of_set_3->left, drawn.left, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(of_set_3->right, drawn.right, cv::NORM_INF), 0);
}

TEST(VirtualSource, ShowsOfALoopDrawnAheadWhatItWouldHaveDrawn) {
    RigConfig config = small_virtual_rig();
    config.source.rate_hz = 5;
    EXPECT_NE(make_source(config)->report().at(0).find("keeps 0 of 120 pairs"), std::string::npos);
    config.virtual_rig.loop_ahead = true;
    std::optional<StereoFrame> frame;
    {
        const auto ahead = make_source(config);
        EXPECT_NE(ahead->report().at(0).find("keeps 120 of 120 pairs"), std::string::npos);
        frame = next_frame(*ahead);
    }
    ASSERT_TRUE(frame);
    const EglContext context;
    const ShaderLibrary shaders;
    VirtualStage stage(shaders);
    const VirtualStereoFrame drawn = render_virtual_rig(
        stage, rig_calibration(config, {config.source.width_px, config.source.height_px}),
        frame->exposure.time_since_epoch(), frame->trigger_index,
        {config.source.noise_sigma, config.source.seed});
    EXPECT_EQ(cv::norm(frame->left, drawn.left, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(frame->right, drawn.right, cv::NORM_INF), 0);
}

TEST(VirtualSource, DrawsAheadOnlyWhatItCanKeep) {
    RigConfig config = small_virtual_rig();
    config.virtual_rig.loop_ahead = true;
    config.virtual_rig.loop_mb = 1;
    EXPECT_EQ(thrown_sentence([&] { make_source(config); }),
              "'loop_ahead' in [virtual_rig] asks for 480 pairs of 61x47, and 58 fit into loop_mb "
              "= 1: raise it, or leave 'loop_ahead' false");
    config.source.rate_hz = 7.01;
    EXPECT_NE(thrown_sentence([&] { make_source(config); }).find("needs a loop that repeats"),
              std::string::npos);
}

TEST(VirtualSource, RefusesCamerasThatItCannotFilmWith) {
    RigConfig config = small_virtual_rig();
    config.virtual_rig.doffs_px = 3;
    EXPECT_NE(thrown_sentence([&] { make_source(config); }).find("'doffs_px'"), std::string::npos);
}

/// Three pictures at 100 Hz, once.
class FilesSourceTest : public testing::Test {
  protected:
    FilesSourceTest() {
        config_.source.kind = "files";
        config_.source.rate_hz = 100;
        config_.source.loop = false;
        config_.source.left = (folder_.path() / "l%d.png").string();
        config_.source.right = (folder_.path() / "r%d.png").string();
        for (int i = 0; i < 3; ++i) {
            write_colour_image(folder_.path() / fmt::format("l{}.png", i), ColourImage(5, 7));
            write_colour_image(folder_.path() / fmt::format("r{}.png", i), ColourImage(5, 7));
        }
    }

    TemporaryFolder folder_;
    RigConfig config_;
};

TEST_F(FilesSourceTest, EndsCleanlyWhereTheMaterialDoes) {
    const auto source = make_source(config_);
    EXPECT_EQ(source->size(), cv::Size(7, 5));
    std::uint64_t frames = 0;
    while (next_frame(*source)) ++frames;
    EXPECT_TRUE(source->ended());
    EXPECT_EQ(frames + source->missed(), 3u);
    EXPECT_FALSE(source->next(1ms));
}

TEST_F(FilesSourceTest, CountsPicturesWhosePulsesHadPassedWhenTheMaterialEnded) {
    const auto source = make_source(config_);
    ASSERT_TRUE(next_frame(*source));
    std::this_thread::sleep_for(100ms);
    EXPECT_FALSE(next_frame(*source));
    EXPECT_TRUE(source->ended());
    EXPECT_EQ(source->missed(), 2u);
}

TEST(Source, IsOneOfThoseThereAre) {
    RigConfig config;
    config.source.kind = "virtul";
    EXPECT_EQ(thrown_sentence([&] { make_source(config); }),
              "there is no source kind 'virtul'; the nearest is 'virtual'");
}

TEST(RigCalibration, IsTheIdealRigWhereNoneIsGiven) {
    RigConfig config = small_virtual_rig();
    config.virtual_rig.doffs_px = 2;
    const StereoCalibration ideal = rig_calibration(config, {61, 47});
    EXPECT_EQ(ideal.rectified.width_px, 61);
    EXPECT_DOUBLE_EQ(ideal.rectified.baseline_m, config.virtual_rig.baseline_m);
    EXPECT_DOUBLE_EQ(ideal.rectified.doffs_px(), 2);
    EXPECT_EQ(ideal.id.size(), 16u);
    EXPECT_NO_THROW(ideal.validate());
}

TEST(RigCalibration, IsRefusedForPicturesOfAnotherSize) {
    const TemporaryFolder folder;
    RigConfig config = small_virtual_rig();
    config.calibration = folder.path() / "c.yaml";
    save_calibration(config.calibration, ideal_rig(config, {64, 48}), {});
    EXPECT_EQ(rig_calibration(config, {64, 48}).rectified.width_px, 64);
    const std::string sentence = thrown_sentence([&] { make_source(config); });
    EXPECT_NE(sentence.find("is for left pictures of 64x48"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("delivers 61x47"), std::string::npos) << sentence;
}

}  // namespace
}  // namespace vantage

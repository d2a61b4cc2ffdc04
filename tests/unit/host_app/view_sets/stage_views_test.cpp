#include "host_app/view_sets/stage_views.h"

#include <fstream>

#include <gtest/gtest.h>

#include "common/config/intrinsics_file.h"
#include "common/config/stage_cameras.h"
#include "common/config/stage_config.h"
#include "common/image/image_file.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

class StageViewsTest : public testing::Test {
  protected:
    StageViewsTest() {
        CameraModel lens;
        lens.width_px = 64;
        lens.height_px = 48;
        lens.fx_px = lens.fy_px = 60;
        lens.cx_px = 31.5;
        lens.cy_px = 23.5;
        lens.distortion = {-0.3, 0, 0, 0};
        save_intrinsics(
            at("lens.yaml"), lens,
            {.date = "2026-01-01", .tool = "test", .sigma = {.distortion = {0, 0, 0, 0}}});
        ColourImage picture(48, 64, cv::Vec4b(10, 20, 30, 255));
        picture.colRange(60, 64).setTo(cv::Vec4b(200, 0, 0, 255));
        write_colour_image(at("picture.png"), picture);
        cv::Mat1b outline(48, 64, static_cast<uchar>(0));
        outline(cv::Rect(20, 10, 20, 30)).setTo(255);
        write_grey_image(at("outline.png"), outline);
    }

    std::string at(const std::string& name) const { return (folder_.path() / name).string(); }
    std::string stage(const std::string& cameras) const {
        std::ofstream(at("stage.toml")) << "version = 1\n" << cameras;
        return at("stage.toml");
    }
    /// An entry as the product writes it.
    std::string entry(const std::string& name, const std::string& source,
                      const std::string& outline) const {
        SingleCamera camera;
        camera.name = name;
        camera.source = source;
        camera.outline = outline;
        camera.world_from_camera = place_;
        return stage_camera_text(camera, "lens.yaml");
    }

    TemporaryFolder folder_;
    Pose place_ = look_at({1, 1.5, 2}, {0, 1, 0});
};

TEST_F(StageViewsTest, ReadsCamerasWithoutTheDistortionOfTheirLenses) {
    const ViewSet set = load_stage_views(
        stage(entry("a", "picture.png", "outline.png") + entry("b", "picture.png", "")));
    ASSERT_EQ(set.views.size(), 2u);
    EXPECT_EQ(set.views[0].name, "a");
    EXPECT_TRUE(set.views[0].world_from_camera.isApprox(place_, 1e-12));
    EXPECT_FALSE(set.views[0].has_depth());
    EXPECT_EQ(set.outlines[0](25, 30), 255);
    EXPECT_EQ(set.outlines[0](3, 3), 0);
    EXPECT_TRUE(set.outlines[1].empty());
    // The lens draws the corners inwards: without it the red edge is further out.
    EXPECT_EQ(set.views[0].colour(24, 61)[0], 10);
    EXPECT_EQ(set.views[0].colour(24, 30)[2], 30);
}

TEST_F(StageViewsTest, NamesTheCameraAndWhatItLacks) {
    const auto refusal = [&](const std::string& cameras) {
        return thrown_sentence([&] { load_stage_views(stage(cameras)); });
    };
    const auto names = [](const std::string& sentence, const char* word) {
        EXPECT_NE(sentence.find(word), std::string::npos) << sentence;
    };
    names(refusal(""), "[[cameras]]");
    names(refusal(entry("a", "", "")), "'a' has no 'source'");
    names(refusal(entry("a", "none.png", "")), "none.png");
    write_colour_image(at("small.png"), ColourImage(24, 32, cv::Vec4b::all(9)));
    names(refusal(entry("a", "small.png", "")), "32x24");
    names(refusal(entry("a", "picture.png", "small.png")), "give an outline of its size");
    names(refusal(entry("a", "picture.png", "") + entry("a", "picture.png", "")), "second time");

    names(refusal("[[cameras]]\nname = \"a\"\ncalibration = \"lens.yaml\"\nworld_from_camera = [2, "
                  "0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]\n"),
          "is not rigid");
}

TEST_F(StageViewsTest, AreNoRigsOfAShow) {
    const std::string cameras = entry("a", "picture.png", "");
    EXPECT_NE(thrown_sentence([&] { load_stage_config(stage(cameras)); }).find("--pairs auto"),
              std::string::npos);
    const StageConfig config = load_stage_config(
        stage("[[rigs]]\nname = \"r\"\nendpoint = \"tcp://127.0.0.1:5600\"\n" + cameras));
    EXPECT_EQ(config.rigs.size(), 1u);
}

}  // namespace
}  // namespace vantage

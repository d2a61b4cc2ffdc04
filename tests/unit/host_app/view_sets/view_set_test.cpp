#include "host_app/view_sets/view_set.h"

#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/config/intrinsics_file.h"
#include "common/config/stage_cameras.h"
#include "common/config/stage_config.h"
#include "common/image/image_file.h"
#include "common/image/pfm.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using nlohmann::json;

const json identity_pose = json::parse("[[1,0,0,0.5],[0,1,0,0],[0,0,1,0]]");

class ViewSetTest : public testing::Test {
  protected:
    ViewSetTest() {
        write_colour_image(path("a.png"), ColourImage(6, 8, cv::Vec4b(10, 20, 30, 255)));
        cv::Mat1w codes(6, 8, ushort{40});
        codes(2, 3) = 0;
        write_grey_image(path("d.png"), codes);
        document_ = {{"version", 1}, {"views", json::array({view("left")})}};
    }

    json view(const std::string& name) const {
        return {{"name", name},
                {"image", "a.png"},
                {"disparity", "d.png"},
                {"scale", 0.25},
                {"unknown", 0},
                {"K", json::parse("[[100,0,3.5],[0,100,2.5],[0,0,1]]")},
                {"world_from_camera", identity_pose},
                {"baseline_m", 0.2},
                {"doffs_px", 30}};
    }

    std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

    ViewSet load() {
        std::ofstream(path("views.json")) << document_.dump();
        return load_view_set(folder_.path());
    }

    /// The sentence with which the present document is refused; empty if it is taken.
    std::string refusal() {
        try {
            load();
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }

    json& first() { return document_["views"][0]; }

    TemporaryFolder folder_;
    json document_;
};

TEST_F(ViewSetTest, TurnsDisparityIntoDepth) {
    const ViewSet set = load();
    ASSERT_EQ(set.views.size(), 1u);
    const DepthView& view = set.views[0];
    EXPECT_EQ(view.name, "left");
    EXPECT_FLOAT_EQ(view.depth_m(0, 0), 100 * 0.2f / (40 * 0.25f + 30));
    EXPECT_EQ(view.depth_m(2, 3), 0);
    EXPECT_EQ(view.colour(5, 7), cv::Vec4b(10, 20, 30, 255));
    EXPECT_DOUBLE_EQ(view.world_from_camera.translation().x(), 0.5);
}

TEST_F(ViewSetTest, ReadsDepthInMetresAndPfmWithoutScale) {
    cv::Mat1f depth(6, 8, 2.5f);
    depth(1, 1) = std::numeric_limits<float>::infinity();
    depth(0, 2) = -1;
    write_pfm(path("z.pfm"), depth);
    for (const char* key : {"disparity", "scale", "unknown", "baseline_m", "doffs_px"})
        first().erase(key);
    first()["depth"] = "z.pfm";
    const DepthView view = load().views[0];
    EXPECT_EQ(view.depth_m(0, 0), 2.5f);
    EXPECT_EQ(view.depth_m(1, 1), 0);
    EXPECT_EQ(view.depth_m(0, 2), 0);
    EXPECT_EQ(view.baseline_m, 0);
}

TEST_F(ViewSetTest, AcceptsAViewWithoutGeometry) {
    first().erase("disparity");
    EXPECT_TRUE(load().views[0].depth_m.empty());
}

TEST_F(ViewSetTest, RefusesEveryMissingKeyByItsName) {
    for (const char* key : {"name", "image", "K", "world_from_camera", "scale", "baseline_m"}) {
        const json whole = first();
        first().erase(key);
        EXPECT_NE(refusal().find(key), std::string::npos) << key << ": " << refusal();
        EXPECT_NE(refusal().find("views.json"), std::string::npos) << refusal();
        first() = whole;
    }
}

TEST_F(ViewSetTest, RefusesWrongValuesByKeyAndView) {
    const std::vector<std::pair<std::string, std::string>> wrong = {
        {"name", "7"},
        {"name", "\"\""},
        {"image", "[]"},
        {"image", "\"nowhere.png\""},
        {"disparity", "3"},
        {"disparity", "\"views.json\""},
        {"scale", "0"},
        {"scale", "-1"},
        {"scale", "\"big\""},
        {"unknown", "\"none\""},
        {"baseline_m", "0"},
        {"doffs_px", "{}"},
        {"K", "[[100,0,3],[0,100,2]]"},
        {"K", "[[100,0,3],[0,100],[0,0,1]]"},
        {"K", "[[0,0,3],[0,100,2],[0,0,1]]"},
        {"K", "[[100,0,3],[0,100,2],[0,0,2]]"},
        {"K", "[[100,0,\"x\"],[0,100,2],[0,0,1]]"},
        {"K", "5"},
        {"world_from_camera", "[[1,0,0,0],[0,1,0,0]]"},
        {"world_from_camera", "[[2,0,0,0],[0,2,0,0],[0,0,2,0]]"},
        {"world_from_camera", "[[1,0,0,0],[0,1,0,0],[0,0,-1,0]]"},
        {"world_from_camera", "[[1,0,0,null],[0,1,0,0],[0,0,1,0]]"},
    };
    for (const auto& [key, value] : wrong) {
        const json whole = first();
        first()[key] = json::parse(value);
        const std::string sentence = refusal();
        EXPECT_FALSE(sentence.empty()) << key << " = " << value << " was taken";
        EXPECT_NE(sentence.find("views.json"), std::string::npos) << sentence;
        EXPECT_EQ(sentence.find("OpenCV"), std::string::npos) << sentence;
        first() = whole;
    }
}

TEST_F(ViewSetTest, RefusesInvalidFiles) {
    for (const char* text : {"", "{", "[]", "7", "{\"version\":2,\"views\":[]}", "{\"version\":1}",
                             "{\"version\":1,\"views\":[]}", "{\"version\":1,\"views\":[3]}",
                             "{\"version\":1,\"views\":{}}", "{\"version\":\"1\",\"views\":[]}",
                             "{\"version\":1e999}"}) {
        std::ofstream(path("views.json")) << text;
        EXPECT_THROW(load_view_set(folder_.path()), Error) << text;
    }
    EXPECT_THROW(load_view_set(path("nowhere")), Error);
}

TEST_F(ViewSetTest, RefusesTwoViewsOfOneNameAndTwoGeometries) {
    document_["views"].push_back(view("left"));
    EXPECT_NE(refusal().find("name"), std::string::npos);
    document_["views"] = json::array({view("left")});
    first()["depth"] = "d.png";
    EXPECT_NE(refusal().find("both"), std::string::npos);
}

TEST_F(ViewSetTest, TakesASmallerMapOfTheSameShapeOnly) {
    write_grey_image(path("small.png"), cv::Mat1w(3, 4, ushort{40}));
    first()["disparity"] = "small.png";
    EXPECT_EQ(load().views[0].depth_m.size(), cv::Size(4, 3));
    write_grey_image(path("small.png"), cv::Mat1w(4, 4, ushort{40}));
    EXPECT_NE(refusal().find("4x4"), std::string::npos) << refusal();
}

TEST_F(ViewSetTest, ListsTheViewsForAnUnknownName) {
    const ViewSet set = load();
    EXPECT_EQ(set.index_of("left"), 0u);
    try {
        set.index_of("right");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("left"), std::string::npos);
    }
}

TEST_F(ViewSetTest, ReadsAPoseFromJsonAndToml) {
    std::ofstream(path("p.json"))
        << R"({"width":64,"height":48,"K":[[50,1,31.5],[0,51,23.5],[0,0,1]],)"
        << R"("world_from_camera":[[1,0,0,0.1],[0,1,0,0.2],[0,0,1,0.3]]})";
    std::ofstream(path("p.toml"))
        << "width = 64\nheight = 48\nK = [[50, 1, 31.5], [0, 51, 23.5], [0, 0, 1]]\n"
        << "world_from_camera = [[1, 0, 0, 0.1], [0, 1, 0, 0.2], [0, 0, 1, 0.3]]\n";
    for (const char* name : {"p.json", "p.toml"}) {
        const VirtualView view = load_virtual_view(path(name));
        EXPECT_EQ(view.width_px, 64);
        EXPECT_EQ(view.height_px, 48);
        EXPECT_EQ(view.K(0, 1), 1);
        EXPECT_EQ(view.world_from_camera.translation(), Eigen::Vector3d(0.1, 0.2, 0.3));
    }
}

TEST_F(ViewSetTest, RefusesInvalidPoses) {
    for (const char* text : {"", "width = 64", "{}", "{\"width\":0,\"height\":1}",
                             "{\"width\":1e9,\"height\":1}", "{\"width\":64,\"height\":48}"}) {
        std::ofstream(path("p.json")) << text;
        EXPECT_THROW(load_virtual_view(path("p.json")), Error) << text;
    }
    std::ofstream(path("p.toml")) << "width = = 3\n";
    EXPECT_THROW(load_virtual_view(path("p.toml")), Error);
    std::ofstream(path("p.toml")) << "width = inf\nheight = nan\n";
    EXPECT_THROW(load_virtual_view(path("p.toml")), Error);
}

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

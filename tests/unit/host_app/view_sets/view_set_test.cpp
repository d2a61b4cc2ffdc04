#include "host_app/view_sets/view_set.h"

#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/image/image_file.h"
#include "common/image/pfm.h"
#include "tests/support/data_folder.h"

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

}  // namespace
}  // namespace vantage

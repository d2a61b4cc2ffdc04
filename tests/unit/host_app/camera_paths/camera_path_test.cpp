#include "host_app/camera_paths/camera_path.h"

#include <fstream>
#include <numbers>
#include <random>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/log.h"
#include "host_app/flight/orbit_view.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

constexpr double deg = std::numbers::pi / 180;

CameraState camera(const Eigen::Vector3d& at, const PanTiltRoll& turn, double angle_deg = 45) {
    CameraState camera;
    camera.world_from_camera.linear() = turned(turn);
    camera.world_from_camera.translation() = at;
    camera.field_of_view_rad = angle_deg * deg;
    camera.focus_m = 3;
    return camera;
}

/// All that a camera on a crane does, and a zoom.
CameraPath crane_path() {
    CameraPath path{50, {1280, 720}, {}};
    for (int i = 0; i < 200; ++i) {
        const double t = 0.02 * i;
        path.cameras.push_back(camera({2 * std::cos(t), 1.5 + 0.3 * t, 2 * std::sin(t)},
                                      {t - 1, -0.2 - 0.1 * t, 0.1 * std::sin(t)}, 50 - 3 * t));
    }
    return path;
}

class CameraPathTest : public testing::Test {
  protected:
    std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
    CameraPath through(const CameraPath& path, const std::string& name) const {
        const CameraPathForm form = form_of(this->path(name));
        form.write(path, this->path(name));
        CameraPathSettings settings;
        settings.rate_hz = path.rate_hz;
        settings.size_px = path.size_px;
        settings.focus_m = 3;
        return form.read(this->path(name), settings);
    }
    static void expect_same(const CameraPath& a, const CameraPath& b, double shift_m,
                            double turn_rad) {
        ASSERT_EQ(a.cameras.size(), b.cameras.size());
        EXPECT_EQ(a.rate_hz, b.rate_hz);
        EXPECT_EQ(a.size_px, b.size_px);
        for (std::size_t i = 0; i < a.cameras.size(); ++i) {
            const CameraState &one = a.cameras[i], &other = b.cameras[i];
            EXPECT_LE((one.world_from_camera.translation() - other.world_from_camera.translation())
                          .norm(),
                      shift_m)
                << i;
            EXPECT_LE(Eigen::AngleAxisd(one.world_from_camera.linear().transpose() *
                                        other.world_from_camera.linear())
                          .angle(),
                      turn_rad)
                << i;
            EXPECT_NEAR(one.field_of_view_rad, other.field_of_view_rad, 2e-5) << i;
            EXPECT_NEAR(one.focus_m, other.focus_m, 1e-3) << i;
        }
    }
    std::string refusal(const std::string& name, const std::string& bytes) const {
        std::ofstream(path(name), std::ios::binary) << bytes;
        return thrown_sentence([&] { (void)form_of(path(name)).read(path(name), {}); });
    }

    TemporaryFolder folder_;
};

TEST_F(CameraPathTest, ComesBackFromEveryForm) {
    const CameraPath crane = crane_path();
    // FreeD has 1/64 mm and 1/32768 degree, glTF floats.
    expect_same(crane, through(crane, "crane.freed"), 2e-5, 1e-6);
    expect_same(crane, through(crane, "images.txt"), 1e-9, 1e-7);
    expect_same(crane, through(crane, "crane.json"), 1e-9, 1e-7);
    expect_same(crane, through(crane, "crane.gltf"), 1e-6, 1e-6);
    expect_same(crane, through(crane, "crane.glb"), 1e-6, 1e-6);
}

TEST_F(CameraPathTest, BecomesAMoveWithinTheToleranceAndCamerasAgain) {
    const CameraPath crane = crane_path();
    const FlightTolerance tolerance{0.005, 0.05 * deg};
    const SimplifiedFlight flight = move_along(crane, tolerance);
    EXPECT_LE(flight.worst, 1);
    EXPECT_LT(flight.move.keyframes().size(), 40u);
    CameraPath again = sampled(flight.move, 50, {1280, 720});
    ASSERT_EQ(again.cameras.size(), crane.cameras.size());
    for (std::size_t i = 0; i < again.cameras.size(); ++i) {
        EXPECT_NEAR(again.cameras[i].focus_m, 3, 0.01);
        again.cameras[i].focus_m = 3;
        EXPECT_NEAR(again.cameras[i].field_of_view_rad, crane.cameras[i].field_of_view_rad,
                    tolerance.turn_rad);
        again.cameras[i].field_of_view_rad = crane.cameras[i].field_of_view_rad;
    }
    expect_same(crane, again, tolerance.shift_m, tolerance.turn_rad);
}

TEST_F(CameraPathTest, KeepsACameraBelowTheFloorWhereItIs) {
    CameraPath path{25, {1280, 720}, {}};
    for (int i = 0; i < 10; ++i) path.cameras.push_back(camera({0.1 * i, -2, 0}, {0, 0, 0}));
    const CameraPath again = sampled(move_along(path, {}).move, 25, {1280, 720});
    expect_same(path, again, 0.01, 1e-3);
}

TEST_F(CameraPathTest, OmafCamerasStandAsTmivProjects) {
    // OMAF's world: x is the stage's -z, y its -x, z its y. A point to the right of a camera that
    // looks along -z, half as high as wide.
    CameraPath path{25, {1000, 500}, {camera({1, 2, 3}, {0, 0, 0}, 90)}};
    through(path, "one.json");
    const nlohmann::json json = nlohmann::json::parse(std::ifstream(this->path("one.json")));
    const nlohmann::json& view = json.at("cameras").at(0);
    EXPECT_EQ(view.at("Position"), (nlohmann::json{-3.0, -1.0, 2.0}));
    for (const nlohmann::json& angle : view.at("Rotation"))
        EXPECT_NEAR(angle.get<double>(), 0, 1e-9) << "it looks along OMAF's x";
    EXPECT_NEAR(view.at("Focal").at(0).get<double>(), 500, 1e-9);
    EXPECT_EQ(view.at("Principle_point"), (nlohmann::json{500.0, 250.0}));
    // Turned to the right is about z, negative; up is about y, negative.
    path.cameras[0] = camera({1, 2, 3}, {30 * deg, 10 * deg, 0}, 90);
    through(path, "two.json");
    const nlohmann::json turned = nlohmann::json::parse(std::ifstream(this->path("two.json")));
    EXPECT_NEAR(turned.at("cameras").at(0).at("Rotation").at(0).get<double>(), -30, 1e-9);
    EXPECT_NEAR(turned.at("cameras").at(0).at("Rotation").at(1).get<double>(), -10, 1e-9);
}

TEST_F(CameraPathTest, ColmapPicturesComeInTheOrderOfTheirNames) {
    std::ofstream(path("cameras.txt")) << "# a lens\n7 SIMPLE_PINHOLE 640 480 640 320 240\n";
    std::ofstream(path("images.txt"))
        << "# two\n1 1 0 0 0 0 0 5 7 b.png\n1 2 3\n2 1 0 0 0 0 0 4 7 a.png\n\n";
    const CameraPath read = form_of(path("images.txt")).read(path("images.txt"), {});
    ASSERT_EQ(read.cameras.size(), 2u);
    EXPECT_NEAR(read.cameras[0].world_from_camera.translation().z(), -4, 1e-12);
    EXPECT_EQ(read.size_px, cv::Size(640, 480));
    EXPECT_NEAR(read.cameras[0].field_of_view_rad, 2 * std::atan(0.5), 1e-12);
}

// What other programs write of COLMAP's form ------------------------------------------------------

std::vector<double> eyes_of(const CameraPath& path) {
    std::vector<double> eyes;
    for (const CameraState& state : path.cameras)
        eyes.push_back(std::round(state.world_from_camera.translation().x() * 1e6) / 1e6);
    return eyes;
}

class ColmapTextTest : public CameraPathTest {
  protected:
    CameraPath read(const std::string& images) const {
        return colmap_path_of(images, "1 PINHOLE 640 480 500 500 320 240\r\n\r\n", "images.txt",
                              {});
    }
    static std::string image(int id, const std::string& name, int eye_x) {
        return fmt::format("{} 1 0 0 0 {} 0 0 1 {}", id, -eye_x, name);
    }
};

TEST_F(ColmapTextTest, NamesHaveSpacesAndNaturalOrder) {
    EXPECT_EQ(eyes_of(read(image(2, "A (2).jpg", 2) + "\n\n" + image(1, "A (1).jpg", 1) + "\n\n")),
              (std::vector<double>{1, 2}));
    EXPECT_EQ(eyes_of(read(image(1, "img_1.jpg", 1) + "\n\n" + image(2, "img_10.jpg", 10) + "\n\n" +
                           image(3, "img_9.jpg", 9) + "\n\n")),
              (std::vector<double>{1, 9, 10}));
}

TEST_F(ColmapTextTest, TheLineOfPointsMayBeEmptyFullOrMissing) {
    const std::string points = "1.5 2.5 -1 3e2 4 17\n";
    for (const std::string& after :
         {std::string("\n"), std::string(), points, std::string("\r\n"), std::string(" \n")}) {
        std::string text = "# Image list with two lines of data per image:\n";
        for (const int i : {1, 2, 3, 4})
            text += image(i, fmt::format("img{}.jpg", i), i * i) + "\n" + after;
        EXPECT_EQ(eyes_of(read(text)), (std::vector<double>{1, 4, 9, 16})) << after;
    }
}

TEST_F(ColmapTextTest, RefusesFewerImagesThanTheHeaderStates) {
    const std::string text = "# Number of images: 3, mean observations per image: 0\n" +
                             image(1, "a.jpg", 1) + "\n\n" + image(2, "b.jpg", 2) + "\n\n";
    EXPECT_NE(thrown_sentence([&] { read(text); }).find("states 3 images and 2"),
              std::string::npos);
}

TEST_F(CameraPathTest, OmafCamerasMayStandInOtherAxes) {
    // A metre right of the first camera and a metre above it, looking ahead.
    const auto stands_at = [&](const std::string& system, const std::string& place) {
        const std::string stated =
            system.empty() ? "" : fmt::format(R"("Axial_system": "{}", )", system);
        const CameraPath path =
            omaf_path_of(fmt::format(R"({{{}"cameras": [{{"Name": "v", "Projection": "Perspective",
                "Position": {}, "Rotation": [0, 0, 0], "Resolution": [640, 480],
                "Focal": [500, 500], "Principle_point": [320, 240]}}]}})",
                                     stated, place),
                         "a.json", {});
        const Pose& pose = path.cameras.at(0).world_from_camera;
        EXPECT_TRUE(pose.linear().col(2).isApprox(-Eigen::Vector3d::UnitZ())) << system;
        EXPECT_TRUE(pose.linear().col(1).isApprox(-Eigen::Vector3d::UnitY())) << system;
        return Eigen::Vector3d(pose.translation());
    };
    const Eigen::Vector3d expected(1, 2, -3);
    EXPECT_TRUE(stands_at("", "[3, -1, 2]").isApprox(expected));
    EXPECT_TRUE(stands_at("OMAF", "[3, -1, 2]").isApprox(expected));
    EXPECT_TRUE(stands_at("OPENGL", "[1, 2, -3]").isApprox(expected));
    EXPECT_TRUE(stands_at("COLMAP", "[1, -2, 3]").isApprox(expected));
    EXPECT_NE(thrown_sentence([&] { stands_at("UNITY", "[1, 2, 3]"); }).find("'UNITY'"),
              std::string::npos);
}

TEST_F(CameraPathTest, OmafCamerasComeAtTheRateThatTheFileStates) {
    const auto read = [](const std::string& keys, const CameraPathSettings& settings = {}) {
        return omaf_path_of("{" + keys + R"("cameras": [{"Name": "v", "Projection": "Perspective",
                "Position": [1, 2, 3], "Rotation": [0, 0, 0], "Resolution": [640, 480],
                "Focal": [500, 500], "Principle_point": [320, 240]}]})",
                            "a.json", settings);
    };
    EXPECT_EQ(read("").rate_hz, 25);
    EXPECT_EQ(read(R"("Fps": 50, )").rate_hz, 50);
    EXPECT_EQ(read(R"("Fps": 50, )", {.rate_hz = 30}).rate_hz, 30) << "as the user says";
    for (const char* fps : {"0", "-1", "1001", "\"many\""})
        EXPECT_NE(thrown_sentence([&] { read(fmt::format(R"("Fps": {}, )", fps)); }), "") << fps;
    log_info("before");
    (void)read(R"("lengthsInMeters": true, )");
    EXPECT_NE(recent_log_lines().back().find("before"), std::string::npos);
    (void)read(R"("lengthsInMeters": false, )");
    EXPECT_NE(recent_log_lines().back().find("another unit than metres"), std::string::npos);
}

// glTF files that have more than one camera on its way
// ---------------------------------------------

class GltfTest : public CameraPathTest {
  protected:
    GltfTest() {
        CameraPath two{
            25, {1280, 720}, {camera({1, 2, 3}, {0, 0, 0}), camera({2, 2, 3}, {0, 0, 0})}};
        through(two, "a.gltf");
        json_ = nlohmann::json::parse(std::ifstream(path("a.gltf")));
    }
    CameraPath read() const {
        const std::string text = json_.dump();
        return gltf_path_of(std::as_bytes(std::span(text)), "a.gltf", {});
    }
    /// What reading the file adds to the log.
    std::string last_warning_of_read() const {
        log_info("before");
        (void)read();
        return recent_log_lines().back();
    }
    nlohmann::json json_;
};

TEST_F(GltfTest, AScaleAboveTheCameraMovesItsEye) {
    nlohmann::json above = {{"name", "cm"}, {"children", {0}}, {"scale", {0.01, 0.01, 0.01}}};
    json_["nodes"].push_back(above);
    EXPECT_TRUE(read().cameras[0].world_from_camera.translation().isApprox(
        Eigen::Vector3d(0.01, 0.02, 0.03), 1e-6));
    json_["nodes"][1].erase("scale");
    json_["nodes"][1]["matrix"] = {0.01, 0, 0, 0, 0, 0.01, 0, 0, 0, 0, 0.01, 0, 5, 0, 0, 1};
    EXPECT_TRUE(read().cameras[0].world_from_camera.translation().isApprox(
        Eigen::Vector3d(5.01, 0.02, 0.03), 1e-6));
    EXPECT_NEAR(read().cameras[0].world_from_camera.linear().determinant(), 1, 1e-9);
    json_["nodes"][0]["scale"] = {3, 3, 3};
    EXPECT_TRUE(read().cameras[0].world_from_camera.translation().isApprox(
        Eigen::Vector3d(5.01, 0.02, 0.03), 1e-6))
        << "its own scale moves no eye";
    json_["nodes"][1]["matrix"] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    EXPECT_NE(thrown_sentence([&] { read(); }).find("mirrors it"), std::string::npos);
}

TEST_F(GltfTest, TheFirstOfSeveralTakesIsTakenAndSaid) {
    nlohmann::json second = json_["animations"][0];
    second["name"] = "second";
    std::swap(second["samplers"][0]["output"], second["samplers"][1]["output"]);
    second["channels"].erase(1);
    second["samplers"][0]["output"] = 1;
    json_["animations"].push_back(second);
    const std::string warning = last_warning_of_read();
    EXPECT_NE(warning.find("'flight' is taken and 'second' is left out"), std::string::npos)
        << warning;
    EXPECT_NEAR(read().cameras[1].world_from_camera.translation().x(), 2, 1e-6);
}

TEST_F(GltfTest, AnimationsOfDifferentThingsBelongTogether) {
    nlohmann::json second = json_["animations"][0];
    second["name"] = "lens";
    second["channels"] = nlohmann::json::array({json_["animations"][0]["channels"][2]});
    json_["animations"][0]["channels"].erase(2);
    json_["animations"].push_back(second);
    EXPECT_EQ(last_warning_of_read().find("takes"), std::string::npos);
    EXPECT_EQ(read().cameras.size(), 2u);
}

TEST_F(GltfTest, TheFirstOfSeveralCamerasIsTakenAndSaid) {
    json_["nodes"].push_back({{"name", "other"}, {"camera", 0}});
    const std::string warning = last_warning_of_read();
    EXPECT_NE(warning.find("'camera' is taken and 'other' is left out"), std::string::npos)
        << warning;
}

TEST_F(CameraPathTest, AnAnimatedParentCarriesAGltfCamera) {
    // The parent goes from x = 0 to 2 in a second; the camera stands a metre above it and looks
    // along the parent's -z, which is turned to +x.
    std::string floats;
    const auto append = [&](std::initializer_list<float> values) {
        for (const float value : values)
            floats.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    append({0, 1});
    append({0, 0, 0, 2, 0, 0});
    std::ofstream(path("way.bin"), std::ios::binary) << floats;
    const double half = std::sqrt(0.5);
    std::ofstream(path("carried.gltf")) << nlohmann::json{
        {"asset", {{"version", "2.0"}}},
        {"nodes",
         {{{"children", {1}}, {"rotation", {0, -half, 0, half}}},
          {{"camera", 0}, {"translation", {0, 1, 0}}}}},
        {"cameras", {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}}},
        {"animations",
         {{{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
           {"samplers", {{{"input", 0}, {"output", 1}}}}}}},
        {"accessors",
         {{{"bufferView", 0}, {"componentType", 5126}, {"count", 2}, {"type", "SCALAR"}},
          {{"bufferView", 0},
           {"byteOffset", 8},
           {"componentType", 5126},
           {"count", 2},
           {"type", "VEC3"}}}},
        {"bufferViews", {{{"buffer", 0}, {"byteLength", 32}}}},
        {"buffers", {{{"byteLength", 32}, {"uri", "way.bin"}}}}};
    CameraPathSettings settings;
    settings.rate_hz = 10;
    const CameraPath read = form_of(path("carried.gltf")).read(path("carried.gltf"), settings);
    ASSERT_EQ(read.cameras.size(), 11u);
    const Pose pose = read.cameras[5].world_from_camera;
    EXPECT_TRUE(pose.translation().isApprox(Eigen::Vector3d(1, 1, 0), 1e-6));
    EXPECT_TRUE(pose.linear().col(2).isApprox(Eigen::Vector3d::UnitX(), 1e-6));
    EXPECT_TRUE(pose.linear().col(1).isApprox(-Eigen::Vector3d::UnitY(), 1e-6));
    EXPECT_NEAR(std::tan(0.5 * read.cameras[0].field_of_view_rad), std::tan(0.25) * 16 / 9, 1e-9);
}

TEST_F(CameraPathTest, ADamagedFileIsReadOrRefused) {
    CameraPath crane = crane_path();
    crane.cameras.resize(4);
    std::mt19937 random(11);
    const auto bytes_of = [&](const std::string& name) {
        std::ostringstream bytes;
        bytes << std::ifstream(path(name), std::ios::binary).rdbuf();
        return bytes.str();
    };
    const auto damaged = [&](std::string bytes) {
        for (int i = static_cast<int>(random() % 4); i >= 0; --i) {
            const std::size_t at = random() % bytes.size();
            if (random() % 3 == 0)
                bytes.erase(at, random() % 30);
            else
                bytes[at] =
                    static_cast<char>(random() % 2 ? random() : "0129-.eE,[{\""[random() % 12]);
            if (bytes.empty()) bytes = "x";
        }
        return bytes;
    };
    for (const char* name : {"a.freed", "images.txt", "a.json", "a.gltf", "a.glb"}) {
        through(crane, name);
        const std::string whole = bytes_of(name), lenses = bytes_of("cameras.txt");
        int refused = 0;
        for (int i = 0; i < 2000; ++i) {
            const std::string bytes = damaged(whole);
            const auto span = std::as_bytes(std::span(bytes));
            const std::string form = form_of(path(name)).name;
            try {
                const CameraPath read = form == "freed" ? freed_path_of(span, name, {})
                                        : form == "colmap"
                                            ? colmap_path_of(bytes, damaged(lenses), name, {})
                                        : form == "omaf" ? omaf_path_of(bytes, name, {})
                                                         : gltf_path_of(span, name, {});
                for (const CameraState& camera : read.cameras)
                    ASSERT_TRUE(camera.world_from_camera.matrix().allFinite()) << name;
            } catch (const Error&) {
                ++refused;
            }
        }
        EXPECT_GT(refused, 100) << name;
    }
}

TEST_F(CameraPathTest, RefusesWhatItCannotFly) {
    const auto expect = [&](const std::string& name, const std::string& bytes,
                            const std::string& words) {
        const std::string sentence = refusal(name, bytes);
        EXPECT_NE(sentence.find(name), std::string::npos) << sentence;
        EXPECT_NE(sentence.find(words), std::string::npos) << sentence;
    };
    expect("a.freed", "", "no camera");
    expect("a.freed", std::string(30, 'x'), "whole number");
    expect("a.freed", std::string(29, 'x'), "message 1");
    expect("a.json", "{", "MPEG view set");
    expect("a.json", R"({"cameras": []})", "no camera");
    expect("a.json", R"({"cameras": [{"Name": "v0", "Projection": "Equirectangular"}]})",
           "only Perspective");
    expect("a.gltf", R"({"nodes": [{}]})", "no perspective camera");
    expect("a.gltf", "nothing", "glTF");
    expect("a.glb", std::string("glTF\2\0\0\0\0\0\0\0\xff\xff\0\0JSON", 20), "cut off");
    std::ofstream(path("cameras.txt")) << "1 OPENCV 640 480 500 500 320 240 0 0 0 0\n";
    const std::string distorted = refusal("images.txt", "1 1 0 0 0 0 0 5 1 b.png\n\n");
    EXPECT_NE(distorted.find("cameras.txt:1"), std::string::npos) << distorted;
    EXPECT_NE(distorted.find("OPENCV"), std::string::npos) << distorted;
    std::ofstream(path("cameras.txt")) << "1 PINHOLE 640 480 50000 50000 320 240\n";
    EXPECT_NE(refusal("images.txt", "1 1 0 0 0 0 0 5 1 b.png\n\n").find("--fov"),
              std::string::npos);
    EXPECT_NE(refusal("images.txt", "1 1 0 0 0 0 0 5 2 b.png\n\n").find("camera 2"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([&] { (void)form_of("a.fbx"); }).find("NAME.freed"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage

#include "host_app/exports/take_export.h"

#include <cstring>
#include <fstream>
#include <numbers>
#include <sstream>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/image/image_file.h"
#include "host_app/exports/camera_files.h"
#include "host_app/exports/moment.h"
#include "host_app/exports/moment_folders.h"
#include "host_app/exports/point_files.h"
#include "host_app/view_sets/view_set.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/source_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/take/small_take.h"

namespace vantage {
namespace {

constexpr double rad = std::numbers::pi / 180;

/// Of the take of version 1: two rigs of 96x72, 15 pulses.
class TakeExportTest : public testing::Test {
  protected:
    std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
    std::string text(const std::string& name) const {
        const std::vector<std::byte> bytes = bytes_of_file(path(name));
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
    std::uint64_t first_pulse() const { return take_.frames(0).front().pulse; }
    Moment first_moment() const { return MomentReader(take_).at(first_pulse()); }

    TemporaryFolder folder_;
    TakeReader take_{source_folder() / "tests" / "takes" / "version_1.mkv"};
};

std::int32_t number_at(const std::array<std::byte, 29>& message, std::size_t at) {
    const auto byte = [&](std::size_t i) { return std::to_integer<std::int32_t>(message[at + i]); };
    const std::int32_t bits = byte(0) << 16 | byte(1) << 8 | byte(2);
    return bits >= 1 << 23 ? bits - (1 << 24) : bits;
}

/// Of a camera that is turned to the right, then up, then clockwise.
Pose turned(double pan_rad, double tilt_rad, double roll_rad) {
    Eigen::Matrix3d level;
    level << 1, 0, 0, 0, -1, 0, 0, 0, -1;
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::AngleAxisd(-pan_rad, Eigen::Vector3d::UnitY()).toRotationMatrix() *
                    Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitX()).toRotationMatrix() *
                    level *
                    Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return pose;
}

TEST(CameraFilesTest, SayPanTiltAndRoll) {
    for (const auto& [pan, tilt, roll] :
         {std::tuple(0.0, 0.0, 0.0), {30.0, 0.0, 0.0}, {-120.0, 20.0, 0.0}, {15.0, -40.0, 5.0}}) {
        const PanTiltRoll turn = pan_tilt_roll_of(turned(pan * rad, tilt * rad, roll * rad));
        EXPECT_NEAR(turn.pan_rad, pan * rad, 1e-12);
        EXPECT_NEAR(turn.tilt_rad, tilt * rad, 1e-12);
        EXPECT_NEAR(turn.roll_rad, roll * rad, 1e-12);
    }
}

TEST(CameraFilesTest, WriteAFreedMessage) {
    CameraRecord camera;
    camera.world_from_camera = turned(90 * rad, -45 * rad, 0);
    camera.world_from_camera.translation() = Eigen::Vector3d(1.5, 2, -3);
    camera.field_of_view_rad = 40 * rad;
    camera.focus_m = 4.25;
    const auto message = freed_message(camera);
    EXPECT_EQ(message[0], std::byte{0xd1});
    EXPECT_EQ(number_at(message, 2), 90 * 32768);
    EXPECT_EQ(number_at(message, 5), -45 * 32768);
    EXPECT_EQ(number_at(message, 8), 0);
    EXPECT_EQ(number_at(message, 11), 1500 * 64);
    EXPECT_EQ(number_at(message, 14), 3000 * 64);
    EXPECT_EQ(number_at(message, 17), 2000 * 64);
    EXPECT_EQ(number_at(message, 20), 40000);
    EXPECT_EQ(number_at(message, 23), 4250);
    unsigned sum = 0;
    for (const std::byte byte : message) sum += std::to_integer<unsigned>(byte);
    EXPECT_EQ(sum & 0xff, 0x40u);
    camera.world_from_camera.translation().x() = 1000;
    EXPECT_EQ(number_at(freed_message(camera), 11), (1 << 23) - 1) << "stays at the limit";
}

TEST_F(TakeExportTest, WritesTheFlight) {
    EXPECT_EQ(export_camera(take_, {}, path("flight")).written, 15u);
    std::istringstream lines(text("flight/camera.csv"));
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line.substr(0, 28), "tick,pulse,timecode,time_s,x");
    for (const CameraRecord& camera : take_.cameras()) {
        ASSERT_TRUE(std::getline(lines, line));
        EXPECT_EQ(line.substr(0, line.find(',', line.find(',') + 1)),
                  fmt::format("{},{}", camera.tick, camera.pulse));
        EXPECT_EQ(std::count(line.begin(), line.end(), ','), 15);
    }
    EXPECT_EQ(text("flight/camera.freed").size(), 15u * 29);
    EXPECT_EQ(export_camera(take_, {0, ~std::uint64_t{0}, 4}, path("few")).written, 4u);
}

TEST_F(TakeExportTest, PutsEveryPixelWithDepthWhereItIs) {
    Moment moment = first_moment();
    ASSERT_EQ(moment.views.size(), 2u);
    moment.views.pop_back();
    const MomentView& view = moment.views[0];
    const std::vector<SurfacePoint> points = surface_points(moment, 1);
    ASSERT_EQ(points.size(), static_cast<std::size_t>(cv::countNonZero(view.depth_m)));
    const Pose camera_from_world = view.world_from_camera.inverse();
    for (const SurfacePoint& point : points) {
        const Eigen::Vector3d at = camera_from_world * point.position_m.cast<double>();
        const Eigen::Vector3d pixel = view.depth_K() * at / at.z();
        const int x = cvRound(pixel.x()), y = cvRound(pixel.y());
        EXPECT_NEAR(pixel.x(), x, 1e-2);
        EXPECT_NEAR(pixel.y(), y, 1e-2);
        ASSERT_NEAR(view.depth_m(y, x), at.z(), 1e-4);
    }
    write_ply(moment, path("one.ply"));
    const std::string ply = text("one.ply");
    const std::size_t begin = ply.find("end_header\n") + 11;
    EXPECT_NE(ply.find(fmt::format("element vertex {}\n", points.size())), std::string::npos);
    ASSERT_EQ(ply.size() - begin, points.size() * 15);
    float z = 0;
    std::memcpy(&z, ply.data() + begin + 15 * (points.size() - 1) + 8, sizeof z);
    EXPECT_EQ(z, points.back().position_m.z());
}

TEST_F(TakeExportTest, WritesGltfThatOthersOpen) {
    const Moment moment = first_moment();
    write_glb(moment, path("one.glb"));
    const std::string glb = text("one.glb");
    const auto number = [&](std::size_t at) {
        std::uint32_t value = 0;
        std::memcpy(&value, glb.data() + at, sizeof value);
        return value;
    };
    EXPECT_EQ(glb.substr(0, 4), "glTF");
    EXPECT_EQ(number(8), glb.size());
    const auto json = nlohmann::json::parse(glb.substr(20, number(12)));
    EXPECT_EQ(number(12) % 4, 0u);
    const std::size_t count = surface_points(moment, 1).size();
    EXPECT_EQ(json["accessors"][0]["count"], count);
    EXPECT_EQ(json["buffers"][0]["byteLength"], count * 20);
    EXPECT_EQ(number(20 + number(12)), count * 20);
    EXPECT_EQ(glb.size(), 20 + number(12) + 8 + count * 20);
    const ProgramResult info = run_to_end("/usr/bin/env", {"assimp", "info", path("one.glb")});
    EXPECT_EQ(info.status, 0) << info.out;
    EXPECT_NE(info.out.find(fmt::format("[{} / 0 / {} | point]", count, count)), std::string::npos)
        << info.out;
}

/// As a trainer reads it: by the text of the COLMAP model alone.
TEST_F(TakeExportTest, WritesAColmapModelWhosePointsMeetItsPictures) {
    const Moment moment = first_moment();
    write_training_folder(moment, path("model"));
    struct Camera {
        double fx = 0, fy = 0, cx = 0, cy = 0;
        Eigen::Quaterniond q;
        Eigen::Vector3d t;
        std::string name;
    };
    std::vector<Camera> cameras;
    std::istringstream words(text("model/sparse/0/cameras.txt"));
    std::string line, model;
    std::getline(words, line);
    for (int id = 0, width = 0, height = 0; words >> id >> model >> width >> height;) {
        Camera& camera = cameras.emplace_back();
        words >> camera.fx >> camera.fy >> camera.cx >> camera.cy;
        EXPECT_EQ(model, "PINHOLE");
        EXPECT_EQ(cv::Size(width, height), cv::Size(96, 72));
    }
    ASSERT_EQ(cameras.size(), 2u);
    words = std::istringstream(text("model/sparse/0/images.txt"));
    std::getline(words, line);
    for (Camera& each : cameras) {
        int id = 0, camera = 0;
        words >> id >> each.q.w() >> each.q.x() >> each.q.y() >> each.q.z() >> each.t.x() >>
            each.t.y() >> each.t.z() >> camera >> each.name;
    }
    words = std::istringstream(text("model/sparse/0/points3D.txt"));
    std::getline(words, line);
    const ColourImage picture = read_colour_image(path("model/images") / cameras[0].name);
    const cv::Mat1w depth = read_code_image(path("model/depth") / "left.png");
    int hits = 0, points = 0;
    for (double id = 0, x = 0, y = 0, z = 0; words >> id >> x >> y >> z; ++points) {
        int r = 0, g = 0, b = 0, error = 0;
        words >> r >> g >> b >> error;
        const Camera& camera = cameras[0];
        const Eigen::Vector3d at = camera.q * Eigen::Vector3d(x, y, z) + camera.t;
        const int u = cvFloor(camera.fx * at.x() / at.z() + camera.cx),
                  v = cvFloor(camera.fy * at.y() / at.z() + camera.cy);
        if (u < 0 || v < 0 || u >= picture.cols || v >= picture.rows) continue;
        hits += picture(v, u) == cv::Vec4b(r, g, b, 255) &&
                std::abs(at.z() - depth(v, u) / 1000.0) < 1e-3;
    }
    EXPECT_GE(hits, points / 2 - 30) << "those of the first rig, of " << points;

    const auto json = nlohmann::json::parse(text("model/transforms.json"));
    const auto& frame = json["frames"][1];
    const MomentView& view = moment.views[1];
    EXPECT_EQ(frame["file_path"], "images/right.jpg");
    EXPECT_EQ(frame["cx"], view.K(0, 2) + 0.5);
    for (int row = 0; row < 3; ++row) {
        EXPECT_EQ(frame["transform_matrix"][row][2], -view.world_from_camera.matrix()(row, 2));
        EXPECT_EQ(frame["transform_matrix"][row][3], view.world_from_camera.matrix()(row, 3));
    }
    for (const auto& [file, form] : {std::pair("images/right.jpg", "mjpeg,96,72"),
                                     {"depth/right.png", "png,96,72,gray16be"}}) {
        const ProgramResult result =
            run_to_end("/usr/bin/env", {"ffprobe", "-v", "error", "-show_entries",
                                        "stream=codec_name,width,height,pix_fmt", "-of", "csv=p=0",
                                        path("model") / file});
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(result.out.substr(0, std::strlen(form)), form);
    }
}

TEST_F(TakeExportTest, WritesAViewSetThatIsReadBack) {
    const Moment moment = first_moment();
    write_view_set(moment, path("views"));
    const ViewSet set = load_view_set(path("views"));
    ASSERT_EQ(set.views.size(), 2u);
    const DepthView& read = set.views[1];
    EXPECT_TRUE(read.K.isApprox(moment.views[1].K, 1e-12));
    EXPECT_TRUE(read.world_from_camera.isApprox(moment.views[1].world_from_camera, 1e-12));
    EXPECT_EQ(cv::norm(read.depth_m, moment.views[1].depth_m, cv::NORM_INF), 0);
}

TEST_F(TakeExportTest, GoesOnWhereItWasBrokenOff) {
    const ExportFormat& ply = find_export_format("ply");
    const TakePart part{first_pulse(), first_pulse() + 10, 3};
    EXPECT_EQ(export_moments(take_, ply, part, path("points")).written, 4u);
    const std::string whole = text("points/000003.ply");
    std::filesystem::rename(path("points/000003.ply"), path("points/partial-000003.ply"));
    std::ofstream(path("points/000006.ply")) << "mine";
    std::ofstream(path("points/partial-000003.ply")) << "half";
    std::vector<double> told;
    const ExportBooks books = export_moments(take_, ply, part, path("points"),
                                             [&](double share) { told.push_back(share); });
    EXPECT_EQ(books.written, 1u);
    EXPECT_EQ(books.there, 3u);
    EXPECT_EQ(text("points/000003.ply"), whole);
    EXPECT_EQ(text("points/000006.ply"), "mine");
    EXPECT_FALSE(std::filesystem::exists(path("points/partial-000003.ply")));
    EXPECT_EQ(told, (std::vector<double>{0, 0.25, 0.5, 0.75}));
    // A longer part goes on too.
    EXPECT_EQ(export_moments(take_, ply, {}, path("points")).written, 11u);
}

TEST_F(TakeExportTest, MixesWithNothingElse) {
    const auto refused = [&](const std::string& form, const std::string& folder,
                             const std::string& words) {
        const std::string sentence = thrown_sentence(
            [&] { export_moments(take_, find_export_format(form), {}, path(folder)); });
        EXPECT_NE(sentence.find(words), std::string::npos) << sentence;
    };
    export_camera(take_, {}, path("flight"));
    refused("ply", "flight", "holds another export already");
    std::ofstream(path("other")) << "mine";
    refused("views", "", "holds other files");
    refused("fbx", "new", "there are camera, film, ply, glb, training, views");
    EXPECT_NE(thrown_sentence([&] {
                  export_moments(take_, find_export_format("ply"), {5, 6, 1}, path("new"));
              }).find("no frame is in that part"),
              std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(path("new")));
}

TEST_F(TakeExportTest, LeavesDamagedFramesOutAndCountsThem) {
    const std::filesystem::path file = path("damaged.mkv");
    write_small_take(file, {"north", "south"}, 100, 103);
    std::vector<std::byte> bytes = bytes_of_file(file);
    bytes[TakeReader(file).frames(0)[1].colour.at + 50] ^= std::byte{1};
    write_bytes(file, bytes);
    const TakeReader take(file);
    const ExportBooks books = export_moments(take, find_export_format("views"), {}, path("views"));
    EXPECT_EQ(books.written, 4u);
    EXPECT_EQ(books.damaged, 1u);
    EXPECT_EQ(load_view_set(path("views/000001")).views.size(), 1u);
    EXPECT_EQ(load_view_set(path("views/000002")).views.size(), 2u);
}

}  // namespace
}  // namespace vantage

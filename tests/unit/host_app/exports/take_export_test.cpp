#include "host_app/exports/take_export.h"

#include <cstring>
#include <fstream>
#include <numbers>
#include <sstream>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/colour/colour_correction.h"
#include "common/image/image_file.h"
#include "host_app/camera_paths/camera_path.h"
#include "host_app/exports/moment.h"
#include "host_app/view_sets/image_metrics.h"
#include "host_app/view_sets/view_set.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/source_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/common/take/small_take.h"

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

TEST(CameraFilesTest, ContainPanTiltAndRoll) {
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

TEST_F(TakeExportTest, PlacesEveryPixelWithDepth) {
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
    // Every triangle is of three neighbours on one surface, whose front the rig sees.
    const auto triangles = surface_triangles(moment);
    EXPECT_GT(triangles.size(), points.size());
    ASSERT_EQ(ply.size() - begin, points.size() * 15 + triangles.size() * 13);
    for (const std::array<std::uint32_t, 3>& triangle : triangles) {
        Eigen::Vector3d corners[3];
        for (std::size_t i = 0; i < 3; ++i)
            corners[i] = camera_from_world * points.at(triangle[i]).position_m.cast<double>();
        for (const Eigen::Vector3d& corner : corners)
            ASSERT_LT(std::abs(corner.z() / corners[0].z() - 1), 0.031);
        const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        ASSERT_LT(normal.dot(corners[0]), 0);
    }
    float z = 0;
    std::memcpy(&z, ply.data() + begin + 15 * (points.size() - 1) + 8, sizeof z);
    EXPECT_EQ(z, points.back().position_m.z());
    const ProgramResult info = run_to_end("/usr/bin/env", {"assimp", "info", path("one.ply")});
    EXPECT_EQ(info.status, 0) << info.out;
    EXPECT_NE(info.out.find("| triangle]"), std::string::npos) << info.out;
}

TEST_F(TakeExportTest, WritesValidGltf) {
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
    const std::size_t triangles = surface_triangles(moment).size();
    EXPECT_EQ(json["accessors"][2]["count"], 3 * triangles);
    const std::size_t bytes = count * 20 + triangles * 12;
    EXPECT_EQ(json["buffers"][0]["byteLength"], bytes);
    EXPECT_EQ(number(20 + number(12)), bytes);
    EXPECT_EQ(glb.size(), 20 + number(12) + 8 + bytes);
    const ProgramResult info = run_to_end("/usr/bin/env", {"assimp", "info", path("one.glb")});
    EXPECT_EQ(info.status, 0) << info.out;
    EXPECT_NE(info.out.find(fmt::format("/ {} | triangle]", triangles)), std::string::npos)
        << info.out;
}

/// As a trainer reads it: by the text of the COLMAP model alone.
TEST_F(TakeExportTest, WritesAConsistentColmapModel) {
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

TEST_F(TakeExportTest, WritesAReadableViewSet) {
    const Moment moment = first_moment();
    write_view_set(moment, path("views"));
    const ViewSet set = load_view_set(path("views"));
    ASSERT_EQ(set.views.size(), 2u);
    const DepthView& read = set.views[1];
    EXPECT_TRUE(read.K.isApprox(moment.views[1].K, 1e-12));
    EXPECT_TRUE(read.world_from_camera.isApprox(moment.views[1].world_from_camera, 1e-12));
    EXPECT_EQ(cv::norm(read.depth_m, moment.views[1].depth_m, cv::NORM_INF), 0);
}

/// The pixels of an OpenEXR file as FFmpeg decodes them.
std::vector<float> decoded(const std::filesystem::path& file, const std::string& format) {
    const std::filesystem::path raw = file.string() + ".raw";
    const ProgramResult result = run_to_end(
        "/usr/bin/ffmpeg",
        {"-v", "error", "-i", file.string(), "-f", "rawvideo", "-pix_fmt", format, raw.string()});
    EXPECT_EQ(result.status, 0) << result.err;
    const std::vector<std::byte> bytes = bytes_of_file(raw);
    std::vector<float> values(bytes.size() / sizeof(float));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
    return values;
}

TEST_F(TakeExportTest, WritesOpenExrThatFfmpegReadsPixelForPixel) {
    const Moment moment = first_moment();
    write_exr_folder(moment, path("exr"));
    const MomentView& view = moment.views[1];
    const std::filesystem::path file = path("exr/right.exr");
    const ProgramResult header = run_to_end("/usr/bin/env", {"exrheader", file.string()});
    EXPECT_EQ(header.status, 0) << header.err;
    for (const char* words :
         {"R, 16-bit floating-point", "G, 16-bit floating-point", "B, 16-bit floating-point",
          "Z, 32-bit floating-point", "dataWindow (type box2i): (0 0) - (95 71)",
          "worldToCamera (type m44f)", "K (type m33f)"})
        EXPECT_NE(header.out.find(words), std::string::npos) << words << header.out;

    const cv::Size size = view.colour.size();
    const auto pixels = static_cast<std::size_t>(size.area());
    const std::vector<float> planes = decoded(file, "gbrpf32le");
    ASSERT_EQ(planes.size(), 3 * pixels);
    const std::size_t plane_of[] = {2, 0, 1};
    for (std::size_t i = 0; i < pixels; ++i)
        for (int c = 0; c < 3; ++c) {
            const double coded =
                view.colour(static_cast<int>(i) / size.width, static_cast<int>(i) % size.width)[c];
            const double linear = srgb_decode(coded / 255);
            ASSERT_NEAR(planes[plane_of[c] * pixels + i], linear, linear / 2048 + 1e-7);
            EXPECT_EQ(std::lround(255 * srgb_encode<double>(planes[plane_of[c] * pixels + i])),
                      coded);
        }
    // FFmpeg knows no depth: under the name of luminance, and the colours under no name, it reads
    // the same bytes.
    std::vector<std::byte> bytes = bytes_of_file(file);
    const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::size_t list = all.find("channels") + 8 + 1 + 6 + 1 + 4;
    const auto rename = [&](char from, char to, int number) {
        // Of a channel a letter, a zero and 16 bytes.
        std::byte& name = bytes[list + static_cast<std::size_t>(number) * 18];
        ASSERT_EQ(name, static_cast<std::byte>(from));
        name = static_cast<std::byte>(to);
    };
    rename('B', 'J', 0);
    rename('G', 'K', 1);
    rename('R', 'L', 2);
    rename('Z', 'Y', 3);
    write_bytes(path("depth.exr"), bytes);
    const std::vector<float> depth = decoded(path("depth.exr"), "grayf32le");
    const DepthImage expected = view.depth_of_pixels();
    ASSERT_EQ(depth.size(), pixels);
    EXPECT_GT(cv::countNonZero(expected), 100);
    for (std::size_t i = 0; i < pixels; ++i)
        ASSERT_EQ(depth[i],
                  expected(static_cast<int>(i) / size.width, static_cast<int>(i) % size.width));
}

TEST_F(TakeExportTest, WritesACorrectMpegViewSet) {
    const Moment moment = first_moment();
    write_mpeg_views(moment, path("mpeg"));
    const std::string words = text("mpeg/sequence.json");
    const auto json = nlohmann::json::parse(words);
    EXPECT_EQ(json.at("sourceCameraNames"), (nlohmann::json{"left", "right"}));
    const CameraPath cameras = omaf_path_of(words, "sequence.json", {});
    ASSERT_EQ(cameras.cameras.size(), 2u);
    const MomentView& view = moment.views[1];
    EXPECT_TRUE(cameras.cameras[1].world_from_camera.isApprox(view.world_from_camera, 1e-9));
    const auto& camera = json.at("cameras").at(1);
    EXPECT_EQ(camera.at("Focal").at(0), view.K(0, 0));
    EXPECT_EQ(camera.at("Principle_point").at(1), view.K(1, 2) + 0.5);

    const ProgramResult picture = run_to_end(
        "/usr/bin/ffmpeg",
        {"-v", "error", "-f", "rawvideo", "-pix_fmt", "yuv420p10le", "-s", "96x72", "-colorspace",
         "bt709", "-i", path("mpeg/right_texture_96x72_yuv420p10le.yuv").string(), "-vf",
         "scale=in_color_matrix=bt709", path("right.png").string()});
    ASSERT_EQ(picture.status, 0) << picture.err;
    EXPECT_GT(psnr_db(read_colour_image(path("right.png")), view.colour), 30);

    const std::string codes = text("mpeg/right_depth_96x72_yuv420p16le.yuv");
    ASSERT_EQ(codes.size(), 96u * 72 * 3);
    const double nearest_m = camera.at("Depth_range").at(0), farthest_m = camera["Depth_range"][1];
    const DepthImage depth = view.depth_of_pixels();
    for (int i = 0; i < 96 * 72; ++i) {
        std::uint16_t code = 0;
        std::memcpy(&code, codes.data() + 2 * i, sizeof code);
        const double z = depth(i / 96, i % 96);
        ASSERT_EQ(code == 0, z == 0);
        if (z == 0) continue;
        const double inverse = 1 / farthest_m + (1 / nearest_m - 1 / farthest_m) * code / 65535.0;
        ASSERT_NEAR(inverse, 1 / z, 1.0 / 65535 / nearest_m);
    }
}

TEST_F(TakeExportTest, ResumesAnInterruptedExport) {
    const ExportFormat& ply = find_export_format("ply");
    const TakePart part{first_pulse(), first_pulse() + 10, 3};
    EXPECT_EQ(export_moments(take_, ply, part, path("points")).written, 4u);
    const std::string whole = text("points/000003.ply");
    std::filesystem::remove(path("points/000003.ply"));
    std::ofstream(path("points/000006.ply")) << "mine";
    // A killed process leaves the beginning of a file in the folder of its moment.
    std::filesystem::create_directory(path("points/partial-000003.ply"));
    std::ofstream(path("points/partial-000003.ply/000003.ply.partial-7")) << "half";
    std::vector<double> told;
    const ExportStats stats = export_moments(take_, ply, part, path("points"),
                                             [&](double share) { told.push_back(share); });
    EXPECT_EQ(stats.written, 1u);
    EXPECT_EQ(stats.there, 3u);
    EXPECT_EQ(text("points/000003.ply"), whole);
    EXPECT_EQ(text("points/000006.ply"), "mine");
    EXPECT_FALSE(std::filesystem::exists(path("points/partial-000003.ply")));
    EXPECT_EQ(told, (std::vector<double>{0, 0.25, 0.5, 0.75}));
    // A longer part goes on too.
    EXPECT_EQ(export_moments(take_, ply, {}, path("points")).written, 11u);
}

TEST_F(TakeExportTest, TwoProcessesWriteTheSameBytes) {
    const std::string take = take_.path().string();
    const auto arguments = [&](const std::string& folder) {
        return std::vector<std::string>{
            "take", "export", take, "--as", "ply", "-o", path(folder).string()};
    };
    const auto with = [](std::vector<std::string> all, const std::vector<std::string>& more) {
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    ASSERT_EQ(run_to_end(VANTAGE_PROGRAM, arguments("whole")).status, 0);
    std::filesystem::create_directory(path("first"));
    std::filesystem::create_directory(path("second"));
    ChildProgram first(VANTAGE_PROGRAM, with(arguments("parts"), {"--to", "0.3"}), path("first"));
    ChildProgram second(VANTAGE_PROGRAM, with(arguments("parts"), {"--from", "0.3"}),
                        path("second"));
    for (ChildProgram* part : {&first, &second}) {
        const ProgramResult result = part->wait();
        ASSERT_EQ(result.status, 0) << result.err;
    }
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(path("whole"))) {
        const std::string file = entry.path().filename().string();
        EXPECT_TRUE(text("whole/" + file) == text("parts/" + file)) << file;
        ++files;
    }
    EXPECT_EQ(files, 16u) << "15 moments and what they are of";
    // An export that is complete says so.
    EXPECT_EQ(run_to_end(VANTAGE_PROGRAM, arguments("parts")).out,
              path("parts").string() + ": all 15 instants existed already, nothing was written\n");
    const std::filesystem::directory_iterator parts(path("parts"));
    EXPECT_EQ(static_cast<std::size_t>(std::distance(begin(parts), end(parts))), files);
}

TEST_F(TakeExportTest, RefusesAFolderWithOtherContent) {
    const auto refused = [&](const std::string& form, const std::string& folder,
                             const std::string& words) {
        const std::string sentence = thrown_sentence(
            [&] { export_moments(take_, find_export_format(form), {}, path(folder)); });
        EXPECT_NE(sentence.find(words), std::string::npos) << sentence;
    };
    export_camera(take_, {}, path("flight"));
    refused("ply", "flight", "contains another export");
    std::ofstream(path("other")) << "mine";
    refused("views", "", "contains other files");
    refused("fbx", "new",
            "the formats are camera, film, otio, edl, ply, glb, exr, training, views, mpeg");
    EXPECT_NE(thrown_sentence([&] {
                  export_moments(take_, find_export_format("ply"), {5, 6, 1}, path("new"));
              }).find("the range has no frames"),
              std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(path("new")));
}

TEST_F(TakeExportTest, SkipsAndCountsDamagedFrames) {
    const std::filesystem::path file = path("damaged.mkv");
    write_small_take(file, {"north", "south"}, 100, 103);
    std::vector<std::byte> bytes = bytes_of_file(file);
    bytes[TakeReader(file).frames(0)[1].colour.at + 50] ^= std::byte{1};
    write_bytes(file, bytes);
    const TakeReader take(file);
    const ExportStats stats = export_moments(take, find_export_format("views"), {}, path("views"));
    EXPECT_EQ(stats.written, 4u);
    EXPECT_EQ(stats.damaged, 1u);
    EXPECT_EQ(load_view_set(path("views/000001")).views.size(), 1u);
    EXPECT_EQ(load_view_set(path("views/000002")).views.size(), 2u);
}

}  // namespace
}  // namespace vantage

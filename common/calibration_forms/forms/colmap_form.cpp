#include <map>
#include <sstream>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "common/calibration_forms/colmap_images.h"
#include "common/calibration_forms/form_tools.h"

namespace vantage {
namespace {

/// COLMAP's pixels have their centres at a half.
constexpr double half_px = 0.5;

bool has_name(const FormFile& file, const char* name) { return file.name() == name; }

bool is_colmap(const FormFile& file) {
    return has_name(file, "cameras.txt") || has_name(file, "images.txt");
}

/// How COLMAP orders the parameters of a model: f or fx, fy; cx, cy; and where each further one
/// stands among OpenCV's coefficients.
struct ColmapModel {
    bool has_one_f = false, is_fisheye = false;
    std::vector<std::size_t> places;
};
const std::map<std::string, ColmapModel>& colmap_models() {
    static const std::map<std::string, ColmapModel> models{
        {"SIMPLE_PINHOLE", {true, false, {}}},
        {"PINHOLE", {false, false, {}}},
        {"SIMPLE_RADIAL", {true, false, {0}}},
        {"RADIAL", {true, false, {0, 1}}},
        {"OPENCV", {false, false, {0, 1, 2, 3}}},
        {"FULL_OPENCV", {false, false, {0, 1, 2, 3, 4, 5, 6, 7}}},
        {"OPENCV_FISHEYE", {false, true, {0, 1, 2, 3}}},
        {"SIMPLE_RADIAL_FISHEYE", {true, true, {0}}},
        {"RADIAL_FISHEYE", {true, true, {0, 1}}},
    };
    return models;
}

CameraModel read_colmap_camera(std::istringstream& words, const std::string& where) {
    std::string name;
    CameraModel camera;
    if (!(words >> name >> camera.width_px >> camera.height_px))
        fail("{}: this is no camera of COLMAP", where);
    const auto model = colmap_models().find(name);
    if (model == colmap_models().end())
        fail("{}: the camera model '{}' is not known to Vantage", where, name);
    std::vector<double> numbers;
    for (double number = 0; words >> number;) numbers.push_back(number);
    const std::size_t first = model->second.has_one_f ? 3 : 4;
    if (numbers.size() != first + model->second.places.size())
        fail("{}: a camera {} has {} parameters, and {} are given", where, name,
             first + model->second.places.size(), numbers.size());
    camera.fx_px = numbers[0];
    camera.fy_px = numbers[first - 3];
    camera.cx_px = numbers[first - 2] - half_px;
    camera.cy_px = numbers[first - 1] - half_px;
    std::vector<double> coefficients(8, 0.0);
    for (std::size_t i = 0; i < model->second.places.size(); ++i)
        coefficients[model->second.places[i]] = numbers[first + i];
    if (model->second.is_fisheye) {
        camera.lens = LensModel::fisheye;
        coefficients.resize(4);
        camera.distortion = coefficients;
    } else {
        camera.distortion = usual_coefficients(coefficients);
    }
    return camera;
}

/// Lines that are neither empty nor comments, with their place.
std::vector<std::pair<std::string, std::string>> content_lines(const FormFile& file) {
    std::vector<std::pair<std::string, std::string>> lines;
    std::istringstream text(file.text);
    std::string line;
    for (int number = 1; std::getline(text, line); ++number)
        if (line.find_first_not_of(" \t\r") != std::string::npos && line[0] != '#')
            lines.emplace_back(fmt::format("{}:{}", file.path.string(), number), line);
    return lines;
}

const FormFile& named(std::span<const FormFile> files, const char* name) {
    for (const FormFile& file : files)
        if (has_name(file, name)) return file;
    fail("COLMAP's model needs {} too: give both cameras.txt and images.txt", name);
}

FormCamera form_camera_of(const ColmapImage& image, const std::map<int, CameraModel>& cameras,
                          const std::filesystem::path& file) {
    const auto model = cameras.find(image.camera);
    if (model == cameras.end())
        fail("{}:{}: camera {} is not in cameras.txt", file.string(), image.line, image.camera);
    FormCamera camera;
    camera.name = image.name;
    camera.model = model->second;
    camera.camera_from_frame = image.camera_from_world;
    return camera;
}

FormCalibration read_colmap(std::span<const FormFile> files, const FormSettings&) {
    std::map<int, CameraModel> cameras;
    for (const auto& [where, line] : content_lines(named(files, "cameras.txt"))) {
        std::istringstream words(line);
        int id = 0;
        if (!(words >> id)) fail("{}: this is no camera of COLMAP", where);
        cameras[id] = read_colmap_camera(words, where);
    }
    FormCalibration result;
    result.assumed = {"pixel centres at a half, as COLMAP defines them, moved to integers",
                      "cameras x right, y down, z forward"};
    result.left_out = {"points and the place of the cameras in COLMAP's world"};
    const FormFile& file = named(files, "images.txt");
    ColmapImages images(file.text, file.path);
    while (const std::optional<ColmapImage> image = images.next())
        result.cameras.push_back(form_camera_of(*image, cameras, file.path));
    return result;
}

std::string camera_line(int id, const CameraModel& camera) {
    const bool is_fisheye = camera.lens == LensModel::fisheye;
    require_plain_lens(camera, is_fisheye ? 4 : 8, "COLMAP");
    const std::size_t used = usual_coefficients(camera.distortion).size();
    const std::string model = is_fisheye ? "OPENCV_FISHEYE" : used > 4 ? "FULL_OPENCV" : "OPENCV";
    std::string line = fmt::format("{} {} {} {} {:.17g} {:.17g} {:.17g} {:.17g}", id, model,
                                   camera.width_px, camera.height_px, camera.fx_px, camera.fy_px,
                                   camera.cx_px + half_px, camera.cy_px + half_px);
    for (std::size_t i = 0; i < (used > 4 && !is_fisheye ? 8u : 4u); ++i)
        line += fmt::format(" {:.17g}", coefficient(camera, i));
    return line + '\n';
}

std::string image_line(int id, const Pose& camera_from_world, const char* name) {
    const Eigen::Quaterniond q(camera_from_world.linear());
    const Eigen::Vector3d t = camera_from_world.translation();
    return fmt::format("{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {} {}\n\n", id,
                       q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z(), id, name);
}

std::vector<FormText> write_colmap(const StereoCalibration& c) {
    const Pose left_from_world = c.world_from_left.inverse();
    return {{"cameras.txt", "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n" +
                                camera_line(1, c.left) + camera_line(2, c.right)},
            {"images.txt", "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n" +
                               image_line(1, left_from_world, "left.png") +
                               image_line(2, c.right_from_left * left_from_world, "right.png")},
            {"points3D.txt", "# POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[]\n"}};
}

}  // namespace

CalibrationForm colmap_form_entry() {
    return {"colmap", "COLMAP (cameras.txt, images.txt)", is_colmap, read_colmap, write_colmap};
}

}  // namespace vantage

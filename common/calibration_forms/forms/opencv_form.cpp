#include <initializer_list>

#include <fmt/format.h>

#include "common/calibration_forms/form_tools.h"

namespace vantage {
namespace {

using Keys = std::initializer_list<const char*>;

const Keys left_matrix{"M1", "K1",     "cameraMatrix1", "camera_matrix_1",    "CM1", "mtx1",
                       "KL", "K_left", "cameraMatrixL", "left_camera_matrix", "mtxL"};
const Keys right_matrix{"M2", "K2",      "cameraMatrix2", "camera_matrix_2",     "CM2", "mtx2",
                        "KR", "K_right", "cameraMatrixR", "right_camera_matrix", "mtxR"};
const Keys left_distortion{"D1",     "distCoeffs1", "distortion_coefficients_1",    "dist1", "DL",
                           "D_left", "distCoeffsL", "left_distortion_coefficients", "distL"};
const Keys right_distortion{
    "D2",      "distCoeffs2", "distortion_coefficients_2",     "dist2", "DR",
    "D_right", "distCoeffsR", "right_distortion_coefficients", "distR"};

/// The first of the keys that one of the files has; empty map: none has.
struct Found {
    const FormFile* file = nullptr;
    std::string key;
    explicit operator bool() const { return file != nullptr; }
    FormMap map() const { return root_of(*file); }

    /// OpenCV writes XML within an element of its own.
    static FormMap root_of(const FormFile& file) {
        if (file.tree.is_object() && file.tree.contains("opencv_storage"))
            return {file.tree["opencv_storage"], file.name()};
        return {file.tree, file.name()};
    }
};

Found find(std::span<const FormFile> files, Keys keys) {
    for (const FormFile& file : files)
        for (const char* key : keys)
            if (Found::root_of(file).has(key)) return {&file, key};
    return {};
}

bool is_opencv(const FormFile& file) {
    const std::span<const FormFile> one(&file, 1);
    const FormMap root = Found::root_of(file);
    // Vantage's own, and those of ROS, which have the same names for a lens.
    for (const char* key : {"kind", "distortion_model", "projection_matrix"})
        if (root.has(key)) return false;
    return find(one, left_matrix) || find(one, right_matrix) || (root.has("R") && root.has("T")) ||
           (root.has("camera_matrix") && root.has("distortion_coefficients"));
}

cv::Size size_in(std::span<const FormFile> files, const FormSettings& settings) {
    if (settings.size_px) return *settings.size_px;
    for (const FormFile& file : files) {
        const FormMap map = Found::root_of(file);
        if (map.has("image_width") && map.has("image_height"))
            return {map.pixels("image_width"), map.pixels("image_height")};
        for (const char* key : {"image_size", "imageSize", "size", "img_size"})
            if (map.has(key)) {
                const std::vector<double> size = map.numbers(key, 2);
                return {static_cast<int>(size[0]), static_cast<int>(size[1])};
            }
    }
    fail("{} states no size of the pictures: give it as --size WIDTHxHEIGHT",
         files.front().path.string());
}

CameraModel camera_of(const Found& matrix, const Found& distortion, cv::Size size,
                      bool is_fisheye) {
    CameraModel camera;
    camera.width_px = size.width;
    camera.height_px = size.height;
    set_matrix(camera, matrix.map().matrix3(matrix.key),
               fmt::format("{}: '{}'", matrix.file->name(), matrix.key));
    if (!distortion) return camera;
    camera.lens = is_fisheye ? LensModel::fisheye : LensModel::pinhole;
    camera.distortion = is_fisheye ? distortion.map().numbers(distortion.key, 4)
                                   : usual_coefficients(distortion.map().numbers(distortion.key));
    return camera;
}

bool is_fisheye_stated(std::span<const FormFile> files, const FormSettings& settings) {
    if (settings.is_fisheye) return true;
    for (const FormFile& file : files) {
        const FormMap map = Found::root_of(file);
        for (const char* key : {"fisheye_model", "fisheye"})
            if (map.has(key) && map.at(key).is_number() && map.number(key) != 0) return true;
    }
    return false;
}

FormCalibration read_opencv(std::span<const FormFile> files, const FormSettings& settings) {
    FormCalibration result;
    result.assumed = {
        "pixel centres at integers, cameras x right, y down, z forward, as OpenCV "
        "defines them"};
    const cv::Size size = size_in(files, settings);
    const bool is_fisheye = is_fisheye_stated(files, settings);
    result.assumed.emplace_back(is_fisheye ? "OpenCV's fisheye lens model"
                                           : "OpenCV's pinhole lens model");
    if (const Found single = find(files, {"camera_matrix"})) {
        for (const FormFile& file : files) {
            const std::span<const FormFile> one(&file, 1);
            if (const Found matrix = find(one, {"camera_matrix"}))
                result.cameras.push_back(
                    {file.path.stem().string(),
                     camera_of(matrix, find(one, {"distortion_coefficients"}), size, is_fisheye)});
        }
        return result;
    }
    const Found left = find(files, left_matrix), right = find(files, right_matrix);
    if (!left || !right)
        fail(
            "{} holds the pose between two cameras and no camera matrices (M1, M2): give the "
            "file with the intrinsics too",
            files.front().path.string());
    const Found rotation = find(files, {"R", "Rot", "rotation"}),
                translation = find(files, {"T", "Trans", "translation", "t"});
    if (!rotation || !translation)
        fail(
            "{} holds camera matrices and no pose between them (R, T): give the file with the "
            "extrinsics too",
            files.front().path.string());
    const std::vector<double> r = rotation.map().numbers(rotation.key);
    if (r.size() != 3 && r.size() != 9)
        fail("{}: '{}' must be a 3x3 matrix or a rotation vector", rotation.file->name(),
             rotation.key);
    const std::vector<double> t = translation.map().numbers(translation.key, 3);
    const Eigen::Matrix3d matrix =
        r.size() == 9 ? matrix3_of(r) : rotation_about({r[0], r[1], r[2]});
    result.cameras.push_back({"left",
                              camera_of(left, find(files, left_distortion), size, is_fisheye),
                              Pose::Identity()});
    result.cameras.push_back(
        {"right", camera_of(right, find(files, right_distortion), size, is_fisheye),
         checked_pose(matrix, {t[0], t[1], t[2]},
                      fmt::format("{}: '{}'", rotation.file->name(), rotation.key))});
    if (find(files, {"R1", "P1", "Q"}))
        result.left_out = {"the rectification (R1, R2, P1, P2, Q); a new one is computed"};
    return result;
}

std::string matrix_of(const char* name, int rows, int columns, const std::vector<double>& numbers) {
    return fmt::format("{}: !!opencv-matrix\n   rows: {}\n   cols: {}\n   dt: d\n   data: {}\n",
                       name, rows, columns, flow_list(numbers));
}

std::vector<double> projection(const RectifiedStereo& r, double cx_px, double shift_m) {
    return {r.f_px, 0, cx_px, r.f_px * shift_m, 0, r.f_px, r.cy_px, 0, 0, 0, 1, 0};
}

std::vector<FormText> write_opencv(const StereoCalibration& c) {
    std::string text =
        fmt::format("%YAML:1.0\n---\nimage_width: {}\nimage_height: {}\nfisheye_model: {}\n",
                    c.left.width_px, c.left.height_px, c.left.lens == LensModel::fisheye ? 1 : 0);
    if (c.left.lens != c.right.lens)
        fail("the two cameras have lenses of different models, and OpenCV's form states one");
    const auto distortion = [](const CameraModel& camera) { return camera.opencv_distortion(); };
    const auto add_lens = [&](const char* K, const char* D, const CameraModel& camera) {
        text += matrix_of(K, 3, 3, rows_of(camera.K()));
        std::vector<double> coefficients = distortion(camera);
        if (coefficients.empty()) coefficients.resize(5, 0.0);
        text += matrix_of(D, 1, static_cast<int>(coefficients.size()), coefficients);
    };
    add_lens("M1", "D1", c.left);
    add_lens("M2", "D2", c.right);
    const Eigen::Vector3d t = c.right_from_left.translation();
    text += matrix_of("R", 3, 3, rows_of(Eigen::Matrix3d(c.right_from_left.linear())));
    text += matrix_of("T", 3, 1, {t.x(), t.y(), t.z()});
    text += matrix_of("R1", 3, 3, rows_of(c.rectified_from_left));
    text += matrix_of("R2", 3, 3, rows_of(c.rectified_from_right));
    text += matrix_of("P1", 3, 4, projection(c.rectified, c.rectified.cx_left_px, 0));
    text += matrix_of("P2", 3, 4,
                      projection(c.rectified, c.rectified.cx_right_px, -c.rectified.baseline_m));
    return {{"stereo.yml", text}};
}

}  // namespace

CalibrationForm opencv_form_entry() {
    return {"opencv", "OpenCV", is_opencv, read_opencv, write_opencv};
}

}  // namespace vantage

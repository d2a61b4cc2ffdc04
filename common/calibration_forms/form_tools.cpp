#include "common/calibration_forms/form_tools.h"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace vantage {
namespace {

void append_numbers(const Tree& tree, std::vector<double>& numbers, const FormMap& map,
                    const std::string& key) {
    if (tree.is_number()) {
        numbers.push_back(tree.get<double>());
    } else if (tree.is_array()) {
        for (const Tree& element : tree) append_numbers(element, numbers, map, key);
    } else if (tree.is_object() && tree.contains("data")) {
        append_numbers(tree["data"], numbers, map, key);
    } else {
        fail("{}: '{}' holds something that is not a number", map.where, key);
    }
}

}  // namespace

const Tree& FormMap::at(const std::string& key) const {
    if (!has(key)) fail("{}: '{}' is missing", where, key);
    return tree[key];
}

FormMap FormMap::map(const std::string& key) const {
    const Tree& value = at(key);
    if (!value.is_object()) fail("{}: '{}' must be a map", where, key);
    return {value, where + ", " + key};
}

std::string FormMap::text(const std::string& key) const {
    const Tree& value = at(key);
    if (!value.is_string()) fail("{}: '{}' must be a text", where, key);
    return value.get<std::string>();
}

double FormMap::number(const std::string& key) const {
    const Tree& value = at(key);
    if (!value.is_number() || !std::isfinite(value.get<double>()))
        fail("{}: '{}' must be a finite number", where, key);
    return value.get<double>();
}

double FormMap::number(const std::string& key, double otherwise) const {
    return has(key) ? number(key) : otherwise;
}

int FormMap::pixels(const std::string& key) const {
    return whole_pixels(number(key), fmt::format("{}: '{}'", where, key));
}

std::vector<double> FormMap::numbers(const std::string& key) const {
    std::vector<double> all;
    append_numbers(at(key), all, *this, key);
    for (const double number : all)
        if (!std::isfinite(number)) fail("{}: '{}' holds a number that is not finite", where, key);
    return all;
}

std::vector<double> FormMap::numbers(const std::string& key, std::size_t count) const {
    std::vector<double> all = numbers(key);
    if (all.size() != count)
        fail("{}: '{}' holds {} numbers and must have {}", where, key, all.size(), count);
    return all;
}

Eigen::Matrix3d FormMap::matrix3(const std::string& key) const {
    return matrix3_of(numbers(key, 9));
}

Pose FormMap::pose(const std::string& key) const {
    const std::vector<double> rows = numbers(key);
    if (rows.size() != 12 && rows.size() != 16)
        fail("{}: '{}' holds {} numbers and must have 3 or 4 rows of 4", where, key, rows.size());
    const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> matrix(rows.data());
    return checked_pose(matrix.leftCols<3>(), matrix.col(3), fmt::format("{}: '{}'", where, key));
}

int whole_pixels(double side, const std::string& where) {
    constexpr double largest = 100'000;
    if (!(side >= 1 && side <= largest) || side != std::floor(side))
        fail("{} is {}, and must be a whole number of pixels", where, side);
    return static_cast<int>(side);
}

Eigen::Matrix3d matrix3_of(const std::vector<double>& numbers) {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers.data());
}

Pose checked_pose(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation,
                  const std::string& where) {
    constexpr double max_error = 1e-3;
    const double error =
        (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (!(error < max_error) || !(rotation.determinant() > 0) || !translation.allFinite())
        fail("{} holds no rotation: it departs from one by {:.3g}", where, error);
    Pose pose = Pose::Identity();
    pose.linear() = rotation;
    pose.translation() = translation;
    // Numbers of few digits are made a rotation; those of all digits stay as they are.
    constexpr double rounding = 1e-13;
    if (error > rounding) {
        const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rotation,
                                                    Eigen::ComputeFullU | Eigen::ComputeFullV);
        pose.linear() = svd.matrixU() * svd.matrixV().transpose();
    }
    return pose;
}

Eigen::Matrix3d rotation_about(const Eigen::Vector3d& vector) {
    const double angle = vector.norm();
    if (angle == 0) return Eigen::Matrix3d::Identity();
    return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

void set_matrix(CameraModel& camera, const Eigen::Matrix3d& K, const std::string& where) {
    if (K(1, 0) != 0 || K(2, 0) != 0 || K(2, 1) != 0 || K(2, 2) != 1)
        fail("{} must be [f_x, skew, c_x; 0, f_y, c_y; 0, 0, 1]", where);
    camera.fx_px = K(0, 0);
    camera.fy_px = K(1, 1);
    camera.cx_px = K(0, 2);
    camera.cy_px = K(1, 2);
    camera.skew_px = K(0, 1);
}

std::vector<double> usual_coefficients(std::vector<double> coefficients) {
    while (!coefficients.empty() && coefficients.back() == 0) coefficients.pop_back();
    for (const std::size_t count : {0, 4, 5, 8, 12, 14})
        if (coefficients.size() <= count) {
            coefficients.resize(count, 0.0);
            break;
        }
    return coefficients;
}

Pose right_from_left_of(const Eigen::Matrix3d& rectified_from_left,
                        const Eigen::Matrix3d& rectified_from_right,
                        const Eigen::Vector3d& right_from_left_rectified) {
    Pose pose = Pose::Identity();
    pose.linear() = rectified_from_right.transpose() * rectified_from_left;
    pose.translation() = rectified_from_right.transpose() * right_from_left_rectified;
    return pose;
}

std::string flow_list(const std::vector<double>& numbers) {
    std::string text;
    for (const double number : numbers)
        text += fmt::format("{}{:.17g}", text.empty() ? "" : ", ", number);
    return "[" + text + "]";
}

std::vector<double> rows_of(const Eigen::Matrix3d& matrix) {
    std::vector<double> numbers;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) numbers.push_back(matrix(row, column));
    return numbers;
}

std::vector<double> rows_of(const Pose& pose) {
    std::vector<double> numbers;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) numbers.push_back(pose.matrix()(row, column));
    return numbers;
}

void require_plain_lens(const CameraModel& camera, std::size_t most_coefficients,
                        const std::string& form) {
    if (camera.skew_px != 0)
        fail("{} has no skew, and this camera's is {} px: it cannot be written", form,
             camera.skew_px);
    for (std::size_t i = most_coefficients; i < camera.distortion.size(); ++i)
        if (camera.distortion[i] != 0)
            fail("{} has {} distortion coefficients, and this lens needs {}: it cannot be written",
                 form, most_coefficients, camera.distortion.size());
}

}  // namespace vantage

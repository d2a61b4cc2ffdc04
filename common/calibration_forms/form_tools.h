#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/error.h"
#include "common/calibration_forms/calibration_form.h"

namespace vantage {

/// One map of a file with the words that tell a person which one it is. Throws Error for what is
/// missing or of another kind.
struct FormMap {
    const Tree& tree;
    std::string where;  ///< "kalibr.yaml, cam0"

    bool has(const std::string& key) const {
        return tree.is_object() && tree.contains(key) && !tree[key].is_null();
    }
    const Tree& at(const std::string& key) const;
    FormMap map(const std::string& key) const;
    std::string text(const std::string& key) const;
    double number(const std::string& key) const;
    double number(const std::string& key, double otherwise) const;
    int pixels(const std::string& key) const;
    /// All numbers below the key, row by row: of a list, of lists of lists, or of a matrix of
    /// OpenCV (a map with `data`).
    std::vector<double> numbers(const std::string& key) const;
    /// As numbers(), exactly so many.
    std::vector<double> numbers(const std::string& key, std::size_t count) const;
    Eigen::Matrix3d matrix3(const std::string& key) const;
    /// Four or three rows of four numbers, [R | t].
    Pose pose(const std::string& key) const;
};

/// A side of a picture. Throws Error, beginning with `where`, unless it is a whole number of
/// pixels.
int whole_pixels(double side, const std::string& where);

/// Row by row, from nine numbers.
Eigen::Matrix3d matrix3_of(const std::vector<double>& numbers);
/// Throws Error, beginning with `where`, unless the left part is a rotation (to a thousandth, and
/// is made one then).
Pose checked_pose(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation,
                  const std::string& where);
/// Rotation about a vector by its length (Rodrigues).
Eigen::Matrix3d rotation_about(const Eigen::Vector3d& vector);

/// Takes f, c and skew from a camera matrix. Throws Error unless it is one.
void set_matrix(CameraModel& camera, const Eigen::Matrix3d& K, const std::string& where);
/// The coefficients without zeros at the end, in as many as OpenCV's functions take.
std::vector<double> usual_coefficients(std::vector<double> coefficients);

/// The relative pose behind a rectified pair: rotations from each camera into the rectified frame,
/// and where the right camera stands in it.
Pose right_from_left_of(const Eigen::Matrix3d& rectified_from_left,
                        const Eigen::Matrix3d& rectified_from_right,
                        const Eigen::Vector3d& right_from_left_rectified);

/// "[1, 2, 3]" with all digits.
std::string flow_list(const std::vector<double>& numbers);
std::vector<double> rows_of(const Eigen::Matrix3d& matrix);
/// Four rows of four.
std::vector<double> rows_of(const Pose& pose);
/// Throws Error for a lens that `form` has no words for: more coefficients, or a skew.
void require_plain_lens(const CameraModel& camera, std::size_t most_coefficients,
                        const std::string& form);

/// Of a distorted pinhole lens, coefficient `i`, or 0.
inline double coefficient(const CameraModel& camera, std::size_t i) {
    return i < camera.distortion.size() ? camera.distortion[i] : 0;
}

}  // namespace vantage

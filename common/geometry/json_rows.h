#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "common/geometry/pose.h"

namespace vantage {

/// The rows of a matrix as an array of arrays.
template <class Derived>
nlohmann::ordered_json json_rows(const Eigen::MatrixBase<Derived>& matrix) {
    auto rows = nlohmann::ordered_json::array();
    for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
        auto row = nlohmann::ordered_json::array();
        for (Eigen::Index c = 0; c < matrix.cols(); ++c) row.push_back(matrix(r, c));
        rows.push_back(std::move(row));
    }
    return rows;
}

/// The rows of [R | t].
inline nlohmann::ordered_json json_rows(const Pose& pose) {
    const Eigen::Matrix<double, 3, 4> matrix = pose.matrix().topRows<3>();
    return json_rows(matrix);
}

}  // namespace vantage

#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "common/geometry/pose.h"

namespace vantage {

// Eigen stores columns first and OpenCV rows first, so these copy element by element.

inline cv::Matx33d to_cv(const Eigen::Matrix3d& m) {
    return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}
inline cv::Vec3d to_cv(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

inline Eigen::Matrix3d to_eigen(const cv::Matx33d& m) {
    Eigen::Matrix3d e;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) e(r, c) = m(r, c);
    return e;
}
inline Eigen::Vector3d to_eigen(const cv::Vec3d& v) { return {v[0], v[1], v[2]}; }

}  // namespace vantage

#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include "common/config/calibration_file.h"
#include "common/geometry/camera_model.h"
#include "common/geometry/pose.h"

namespace vantage {

/// The checksum of calibration files (FNV-1a, 64 bits) over numbers, each in the shortest decimal
/// form that parses to the same value; -0 counts as 0.
class NumberChecksum {
  public:
    void add(double number);
    void add(std::string_view text);
    void add(const CameraModel& camera);
    void add(const Pose& pose);
    void add(const CalibrationSigma::Camera& sigma);
    template <class Derived>
    void add_rows(const Eigen::MatrixBase<Derived>& m) {
        for (Eigen::Index r = 0; r < m.rows(); ++r)
            for (Eigen::Index c = 0; c < m.cols(); ++c) add(m(r, c));
    }

    /// 16 hexadecimal digits.
    std::string hex() const;

  private:
    std::uint64_t hash_ = 0xcbf29ce484222325ull;
};

/// Throws Error unless `stated`, as files have it, is the checksum with these digits.
void require_checksum(const std::string& stated, const std::string& hex);
/// The form in files: "fnv1a64:" and the digits.
std::string checksum_text(const std::string& hex);

}  // namespace vantage

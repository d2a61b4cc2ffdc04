#pragma once

#include <cstddef>

#include <opencv2/core.hpp>

#include "common/config/calibration_file.h"
#include "common/config/yaml_section.h"

namespace vantage {

/// Reads `lens` and, by these keys, the camera matrix and the distortion. Throws Error.
void read_lens(const YamlSection& section, const char* K_key, const char* distortion_key,
               CameraModel& camera);

/// The keys of a camera's deviations, into the map that is open.
void write_lens_sigma(cv::FileStorage& file, const CalibrationSigma::Camera& sigma);
/// Throws Error, also unless there is a deviation for each of so many coefficients.
CalibrationSigma::Camera read_lens_sigma(const YamlSection& section, std::size_t coefficients);

}  // namespace vantage

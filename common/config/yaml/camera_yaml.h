#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include <opencv2/core.hpp>

#include "common/config/calibration_file.h"
#include "common/config/yaml/yaml_section.h"
#include "common/geometry/camera_model.h"

namespace vantage {

/// Reads `lens` and, by these keys, the camera matrix and the distortion. Throws Error.
void read_lens(const YamlSection& section, const char* K_key, const char* distortion_key,
               CameraModel& camera);

/// Writes a camera's standard deviations into the open map.
void write_lens_sigma(cv::FileStorage& file, const CalibrationSigma::Camera& sigma);
/// Reads them. Throws Error, also unless there is one per distortion coefficient.
CalibrationSigma::Camera read_lens_sigma(const YamlSection& section, std::size_t coefficients);

/// The name of a lens model in calibration files, and the model of a name; empty if unknown.
const char* lens_name(LensModel lens);
std::optional<LensModel> lens_named(std::string_view name);

}  // namespace vantage

#include "common/config/yaml/camera_yaml.h"

#include <optional>
#include <string>

#include "common/base/error.h"

namespace vantage {

void read_lens(const YamlSection& section, const char* K_key, const char* distortion_key,
               CameraModel& camera) {
    const std::string name = section.text("lens");
    const std::optional<LensModel> lens = lens_named(name);
    if (!lens) fail("'{}lens' is '{}', but must be pinhole or fisheye", section.name, name);
    camera.lens = *lens;
    const Eigen::Matrix3d K = section.matrix3(K_key);
    if (K(1, 0) != 0 || K(2, 0) != 0 || K(2, 1) != 0 || K(2, 2) != 1)
        fail("'{}{}' must be [f_x, skew, c_x; 0, f_y, c_y; 0, 0, 1]", section.name, K_key);
    camera.fx_px = K(0, 0);
    camera.fy_px = K(1, 1);
    camera.cx_px = K(0, 2);
    camera.cy_px = K(1, 2);
    camera.skew_px = K(0, 1);
    camera.distortion = section.matrix(distortion_key);
}

void write_lens_sigma(cv::FileStorage& file, const CalibrationSigma::Camera& sigma) {
    file << "fx_px" << sigma.fx_px << "fy_px" << sigma.fy_px << "cx_px" << sigma.cx_px << "cy_px"
         << sigma.cy_px << "distortion" << to_yaml_row(sigma.distortion);
}

CalibrationSigma::Camera read_lens_sigma(const YamlSection& section, std::size_t coefficients) {
    CalibrationSigma::Camera sigma;
    sigma.fx_px = section.deviation("fx_px");
    sigma.fy_px = section.deviation("fy_px");
    sigma.cx_px = section.deviation("cx_px");
    sigma.cy_px = section.deviation("cy_px");
    sigma.distortion = section.matrix("distortion");
    if (sigma.distortion.size() != coefficients)
        fail("'{}distortion' has {} numbers for {} coefficients", section.name,
             sigma.distortion.size(), coefficients);
    return sigma;
}

const char* lens_name(LensModel lens) { return lens == LensModel::fisheye ? "fisheye" : "pinhole"; }

std::optional<LensModel> lens_named(std::string_view name) {
    for (const LensModel lens : {LensModel::pinhole, LensModel::fisheye})
        if (name == lens_name(lens)) return lens;
    return {};
}

}  // namespace vantage

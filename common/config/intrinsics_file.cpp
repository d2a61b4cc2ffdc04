#include "common/config/intrinsics_file.h"

#include "common/config/yaml/camera_yaml.h"
#include "common/config/yaml/number_checksum.h"

namespace vantage {
namespace {

constexpr YamlKind intrinsics_kind{"vantage camera intrinsics", "the lens of a camera", 2};
constexpr const char* intrinsics_units =
    "pixels, pixel centres at integers, origin top-left; distortion in OpenCV's order";

std::string checksum_of(const CameraModel& camera, const CalibrationSigma::Camera& sigma) {
    NumberChecksum checksum;
    checksum.add(camera);
    checksum.add(sigma);
    return checksum.hex();
}

/// The checksum of version 1, which left out the uncertainties.
std::string first_checksum_of(const CameraModel& camera) {
    NumberChecksum checksum;
    checksum.add(camera);
    return checksum.hex();
}

CameraModel read_intrinsics(const YamlSection& top) {
    CameraModel camera;
    camera.width_px = top.integer("image_width");
    camera.height_px = top.integer("image_height");
    read_lens(top, "camera_matrix", "distortion_coefficients", camera);
    camera.validate();
    const CalibrationSigma::Camera sigma =
        read_lens_sigma(top.section("sigma"), camera.distortion.size());
    require_checksum(top.text("checksum"), top.integer("version") == 1
                                               ? first_checksum_of(camera)
                                               : checksum_of(camera, sigma));
    return camera;
}

}  // namespace

CameraModel load_intrinsics(const std::filesystem::path& path) {
    return read_yaml(path, intrinsics_kind, read_intrinsics);
}

void save_intrinsics(const std::filesystem::path& path, const CameraModel& camera,
                     const IntrinsicsRecord& record) {
    camera.validate();
    cv::FileStorage file("camera.yaml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    file << "kind" << intrinsics_kind.kind << "version" << intrinsics_kind.version << "units"
         << intrinsics_units;
    file << "date" << record.date << "tool" << record.tool;
    file << "avg_reprojection_error" << record.rms_px << "views_used" << record.views_used;
    file << "checksum" << checksum_text(checksum_of(camera, record.sigma));
    file << "image_width" << camera.width_px << "image_height" << camera.height_px;
    file << "lens" << lens_name(camera.lens);
    file << "camera_matrix" << to_yaml_matrix(camera.K());
    file << "distortion_coefficients" << to_yaml_row(camera.distortion);
    file << "sigma"
         << "{";
    write_lens_sigma(file, record.sigma);
    file << "}";
    write_yaml_keeping_last(path, file.releaseAndGetString(), load_intrinsics);
}

}  // namespace vantage

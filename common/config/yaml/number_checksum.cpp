#include "common/config/yaml/number_checksum.h"

#include <fmt/format.h>

#include "common/base/error.h"
#include "common/config/yaml/camera_yaml.h"

namespace vantage {

void NumberChecksum::add(double number) { add(fmt::format("{};", number == 0 ? 0.0 : number)); }

void NumberChecksum::add(std::string_view text) {
    for (const char c : text) {
        hash_ ^= static_cast<unsigned char>(c);
        hash_ *= 0x100000001b3ull;
    }
}

void NumberChecksum::add(const CameraModel& camera) {
    add(camera.width_px);
    add(camera.height_px);
    add(lens_name(camera.lens));
    add_rows(camera.K());
    add(static_cast<double>(camera.distortion.size()));
    for (const double k : camera.distortion) add(k);
}

void NumberChecksum::add(const Pose& pose) {
    add_rows(pose.linear());
    add_rows(pose.translation());
}

void NumberChecksum::add(const CalibrationSigma::Camera& sigma) {
    for (const double value : {sigma.fx_px, sigma.fy_px, sigma.cx_px, sigma.cy_px}) add(value);
    add(static_cast<double>(sigma.distortion.size()));
    for (const double value : sigma.distortion) add(value);
}

std::string NumberChecksum::hex() const { return fmt::format("{:016x}", hash_); }

std::string checksum_text(const std::string& hex) { return "fnv1a64:" + hex; }

void require_checksum(const std::string& stated, const std::string& hex) {
    if (stated != checksum_text(hex))
        fail(
            "the checksum does not match the numbers ({} would): the file was changed or is "
            "damaged; calibrate again or restore the last good file",
            checksum_text(hex));
}

}  // namespace vantage

#include "common/rectification/rectify_pass.h"

#include <stdexcept>
#include <string>

#include "common/base/error.h"
#include "common/rectification/packed_positions.h"

namespace vantage {
namespace {

const CameraModel& camera_of(const StereoCalibration& calibration, Side side) {
    return side == Side::left ? calibration.left : calibration.right;
}

/// One pixel stands in for the whole where nothing has to be resampled.
Texture make_target(TextureFormat format, const StereoCalibration& calibration, bool is_identity) {
    const RectifiedStereo& rectified = calibration.rectified;
    const Filter filter = format == TextureFormat::rgba8 ? Filter::linear : Filter::nearest;
    return is_identity ? Texture(format, 1, 1)
                       : Texture(format, rectified.width_px, rectified.height_px, filter);
}

}  // namespace

RectifyPass::RectifyPass(const ShaderLibrary& library, const StereoCalibration& calibration,
                         Side side)
    : library_(library),
      calibration_id_(calibration.id),
      side_(side),
      raw_size_(camera_of(calibration, side).width_px, camera_of(calibration, side).height_px),
      is_identity_(is_identity(calibration, side)),
      packed_(is_identity_
                  ? std::nullopt
                  : packed_positions(make_rectification_map(calibration, side), raw_size_)),
      is_packed_(packed_.has_value()),
      positions_(make_target(packed_ ? TextureFormat::r32ui : TextureFormat::rg32f, calibration,
                             is_identity_)),
      rectified_(make_target(TextureFormat::rgba8, calibration, is_identity_)),
      target_({&rectified_}),
      pass_(library, "rectify.frag", {{"PACKED", packed_ ? "1" : "0"}}) {
    if (is_identity_) return;
    positions_.upload(packed_ ? cv::Mat(*packed_) : make_rectification_map(calibration, side));
    packed_.reset();
}

const Texture& RectifyPass::rectify(const Texture& raw) {
    require_raw_size(raw.size());
    if (is_identity_) return raw;
    Program& program = pass_.use();
    program.input("raw", raw);
    return run(pass_, program);
}

const Texture& RectifyPass::rectify(const RawPlanes& raw) {
    require_raw_size(raw.size);
    if (is_identity_) throw std::logic_error("planes of a rectified camera are not resampled");
    if (!planes_pass_ || planes_format_ != raw.shader_format) {
        planes_pass_.emplace(library_, "rectify.frag",
                             ShaderDefines{{"PACKED", is_packed_ ? "1" : "0"},
                                           {"PLANES", "1"},
                                           {"FORMAT", std::to_string(raw.shader_format)}});
        planes_format_ = raw.shader_format;
    }
    Program& program = planes_pass_->use();
    raw.inputs(program);
    program.set("raw_size", Eigen::Vector2i(raw_size_.width, raw_size_.height));
    program.set("first_column_px", raw.first_column_px);
    const auto texel_of = [](cv::Size size) {
        return Eigen::Vector2f(1.0F / static_cast<float>(size.width),
                               1.0F / static_cast<float>(size.height));
    };
    program.set("raw_texel", texel_of(raw.plane_sizes.front()));
    program.set("chroma_texel", texel_of(raw.plane_sizes.back()));
    return run(*planes_pass_, program);
}

void RectifyPass::require_raw_size(cv::Size size) const {
    if (size == raw_size_) return;
    fail(
        "the calibration {} is for pictures of {}x{}, and the {} camera's are {}x{}; calibrate "
        "at that size or set the camera to the calibrated one",
        calibration_id_, raw_size_.width, raw_size_.height, side_ == Side::left ? "left" : "right",
        size.width, size.height);
}

const Texture& RectifyPass::run(FullscreenPass& pass, Program& program) {
    program.input("positions", positions_);
    pass.overwrite(target_);
    return rectified_;
}

std::size_t RectifyPass::bytes_moved(double raw_bytes_per_pixel) const {
    if (is_identity_) return 0;
    // A good cache reads each raw texel once.
    const double raw_bytes = raw_size_.area() * raw_bytes_per_pixel;
    return static_cast<std::size_t>(raw_bytes) + positions_.bytes() + rectified_.bytes();
}

std::size_t RectifyPass::gpu_bytes() const { return positions_.bytes() + rectified_.bytes(); }

}  // namespace vantage

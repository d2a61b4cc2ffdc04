#include "common/rectification/rectify_pass.h"

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
    return is_identity ? Texture(format, 1, 1)
                       : Texture(format, rectified.width_px, rectified.height_px);
}

}  // namespace

RectifyPass::RectifyPass(const ShaderLibrary& library, const StereoCalibration& calibration,
                         Side side)
    : calibration_id_(calibration.id),
      side_(side),
      raw_size_(camera_of(calibration, side).width_px, camera_of(calibration, side).height_px),
      is_identity_(is_identity(calibration, side)),
      packed_(is_identity_
                  ? std::nullopt
                  : packed_positions(make_rectification_map(calibration, side), raw_size_)),
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
    if (raw.size() != raw_size_)
        fail(
            "the calibration {} is for pictures of {}x{}, and the {} camera's are {}x{}; calibrate "
            "at that size or set the camera to the calibrated one",
            calibration_id_, raw_size_.width, raw_size_.height,
            side_ == Side::left ? "left" : "right", raw.width_px(), raw.height_px());
    if (is_identity_) return raw;
    Program& program = pass_.use();
    program.set("raw", 0);
    program.set("positions", 1);
    raw.bind(0);
    positions_.bind(1);
    pass_.overwrite(target_);
    return rectified_;
}

std::size_t RectifyPass::bytes_moved() const {
    if (is_identity_) return 0;
    // A good cache reads each raw texel once.
    const auto raw_bytes = static_cast<std::size_t>(raw_size_.area()) * 4;
    return raw_bytes + positions_.bytes() + rectified_.bytes();
}

std::size_t RectifyPass::gpu_bytes() const { return positions_.bytes() + rectified_.bytes(); }

}  // namespace vantage

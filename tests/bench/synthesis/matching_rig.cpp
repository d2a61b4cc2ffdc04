#include "tests/bench/synthesis/matching_rig.h"

#include <numbers>

#include <fmt/format.h>

#include "common/wire/codec/right_picture.h"
#include "common/wire/frame_codec.h"
#include "rig_firmware/daemon/gpu_stage.h"

namespace vantage {

StereoCalibration rig_at(double azimuth_deg, cv::Size size) {
    return ideal_virtual_rig({.azimuth_rad = azimuth_deg * std::numbers::pi / 180,
                              .width_px = size.width,
                              .height_px = size.height});
}

VirtualView camera_of(const StereoCalibration& rig) {
    return {rig.left.width_px, rig.left.height_px, rig.left.K(), rig.world_from_left};
}

MatchingRig::MatchingRig(const ShaderLibrary& library, double azimuth_deg, std::uint64_t seed,
                         const Settings& settings)
    : calibration_(rig_at(azimuth_deg, settings.size)),
      rig_(calibration_, {.sigma = settings.noise_sigma, .seed = seed}),
      left_(TextureFormat::rgba8, settings.size.width, settings.size.height, Filter::linear),
      right_(TextureFormat::rgba8, settings.size.width, settings.size.height, Filter::linear),
      matched_size_(reduced_size(settings.size, settings.match_width_px)),
      matcher_(make_matcher(default_matcher(settings.preset), library,
                            {.width_px = matched_size_.width,
                             .height_px = matched_size_.height,
                             .disparities = settings.disparities,
                             .preset = settings.preset,
                             .of_stream = true})),
      steady_(library, matched_size_.width, matched_size_.height),
      jpeg_quality_(settings.jpeg_quality),
      chroma_(settings.chroma) {
    if (matched_size_ != settings.size) reduce_.emplace(library, settings.size, matched_size_);
    view_.name = fmt::format("{:g}", azimuth_deg);
    view_.K = calibration_.left.K();
    view_.world_from_camera = calibration_.world_from_left;
    view_.baseline_m = calibration_.rectified.baseline_m;
    view_.doffs_px = calibration_.rectified.doffs_px();
}

void MatchingRig::film(VirtualStage& stage, std::chrono::nanoseconds stage_time,
                       std::uint64_t instant) {
    VirtualStereoFrame frame = rig_.render(stage, stage_time, instant);
    left_.upload(frame.left);
    right_.upload(frame.right);
    const Texture& left = reduce_ ? reduce_->left.reduce(left_) : left_;
    const Texture& right = reduce_ ? reduce_->right.reduce(right_) : right_;
    const cv::Mat found = steady_.run(matcher_->match(left, right), left).download();
    view_.colour = frame.left;
    if (jpeg_quality_ > 0)
        view_.colour =
            JpegDecoder().decode(JpegEncoder().encode(frame.left, jpeg_quality_, chroma_),
                                 frame.left.cols, frame.left.rows);
    if (!right_sent_ || stage_time - *right_sent_ >= right_period) {
        JpegEncoder jpeg;
        view_.right_jpeg = shared(pack_right_picture(jpeg, frame.right));
        right_sent_ = stage_time;
    }
    own_m_ = depth_of(found);
    exact_m_ = depth_of(frame.exact_disparity);
}

StageCamera MatchingRig::camera() const {
    return {calibration_.left.width_px, calibration_.left.height_px, calibration_.left.K(),
            calibration_.world_from_left};
}

DepthView MatchingRig::view(bool with_own_depth) const {
    DepthView view = view_;
    view.depth_m = with_own_depth ? own_m_ : exact_m_;
    return view;
}

DepthImage MatchingRig::depth_of(const cv::Mat& disparity) const {
    const double px_per_step = calibration_.rectified.width_px /
                               static_cast<double>(disparity.cols * disparity_steps_per_px);
    DepthImage depth_m(disparity.size());
    for (int y = 0; y < depth_m.rows; ++y)
        for (int x = 0; x < depth_m.cols; ++x) {
            const auto steps = disparity.at<std::uint16_t>(y, x);
            depth_m(y, x) =
                steps > 0 ? static_cast<float>(calibration_.rectified.depth_m(steps * px_per_step))
                          : 0.0f;
        }
    return depth_m;
}

}  // namespace vantage

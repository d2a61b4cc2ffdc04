#include "rig_firmware/daemon/gpu_stage.h"

#include <chrono>

#include "common/base/error.h"

namespace vantage {
namespace {

float milliseconds_since(MonotonicTime start) {
    return std::chrono::duration<float, std::milli>(MonotonicClock::now() - start).count();
}

std::string chosen_matcher(const RigConfig& config) {
    if (config.match.matcher == exact_matcher && config.source.kind != "virtual")
        fail(
            "'matcher = \"exact\"' takes the virtual stage's own depth, and the source is '{}': "
            "leave 'matcher' out or name a real one",
            config.source.kind);
    if (!config.match.matcher.empty()) return config.match.matcher;
    return default_matcher(parse_preset(config.match.preset));
}

std::unique_ptr<Matcher> chosen(const std::string& name, const RigConfig& config,
                                const ShaderLibrary& shaders, const RectifiedStereo& geometry) {
    if (name == exact_matcher) return nullptr;
    return make_matcher(name, shaders,
                        {.width_px = geometry.width_px,
                         .height_px = geometry.height_px,
                         .disparities = config.match.disparities,
                         .preset = parse_preset(config.match.preset),
                         .fill = config.match.fill});
}

}  // namespace

GpuStage::GpuStage(const RigConfig& config, const StereoCalibration& calibration)
    : info_(GlInfo::query()),
      calibration_(calibration),
      matcher_name_(chosen_matcher(config)),
      disparities_(config.match.disparities),
      rectified_already_(is_identity(calibration, Side::left)),
      left_raw_(TextureFormat::rgba8, calibration.left.width_px, calibration.left.height_px),
      right_raw_(TextureFormat::rgba8, calibration.right.width_px, calibration.right.height_px),
      rectify_left_(shaders_, calibration, Side::left),
      rectify_right_(shaders_, calibration, Side::right),
      matcher_(chosen(matcher_name_, config, shaders_, calibration.rectified)) {
    info_.require_vantage_minimum();
    if (matcher_ && config.match.steady)
        steady_.emplace(shaders_, calibration.rectified.width_px, calibration.rectified.height_px);
    if (rectified_already_ && !matcher_) return;
    // Drivers finish their programs at the first drawing: seconds, where the processor draws, in
    // which real frames would be lost.
    StereoFrame dark;
    dark.left = ColourImage(left_raw_.size(), cv::Vec4b(0, 0, 0, 255));
    dark.right = ColourImage(right_raw_.size(), cv::Vec4b(0, 0, 0, 255));
    RigFrame unused;
    rectify_and_match(dark, unused);
}

RigFrame GpuStage::process(StereoFrame frame) {
    shaders_.poll();
    RigFrame result;
    const MonotonicTime start = MonotonicClock::now();
    if (matcher_ || !rectified_already_) {
        rectify_and_match(frame, result);
    } else {
        result.colour = std::move(frame.left);
    }
    if (!matcher_) {
        if (frame.exact_disparity.empty())
            fail("the source delivers no exact disparity: name a real matcher");
        result.disparity = std::move(frame.exact_disparity);
    }
    result.times.match_ms = milliseconds_since(start) - result.times.rectify_ms;

    result.synchronized = frame.synchronized;
    result.trigger_index = frame.trigger_index;
    result.exposure = frame.exposure;
    result.calibration_id = calibration_.id;
    result.geometry = calibration_.rectified;
    result.world_from_camera = calibration_.world_from_rectified_left();
    result.max_disparity_px = static_cast<float>(disparities_);
    return result;
}

void GpuStage::rectify_and_match(const StereoFrame& frame, RigFrame& result) {
    rectify_timer_.begin();
    left_raw_.upload(frame.left);
    const Texture& left = rectify_left_.rectify(left_raw_);
    const Texture* right = nullptr;
    if (matcher_) {
        right_raw_.upload(frame.right);
        right = &rectify_right_.rectify(right_raw_);
    }
    rectify_timer_.end();
    const Texture* disparity = matcher_ ? &matcher_->match(left, *right) : nullptr;
    if (disparity && steady_) disparity = &steady_->run(*disparity, left);
    // Everything is under way before the first read waits for the GPU.
    result.colour = rectified_already_ ? frame.left : ColourImage(left.download());
    if (disparity) result.disparity = disparity->download();
    result.times.rectify_ms = static_cast<float>(rectify_timer_.wait_ms());
}

std::vector<std::string> GpuStage::report() const {
    std::vector<std::string> lines;
    for (const EglAttempt& attempt : context_.attempts())
        lines.push_back(fmt::format("EGL {}: {}", attempt.platform, attempt.outcome));
    lines.push_back(fmt::format("GPU: {}, {}", info_.renderer, info_.version));
    lines.push_back(rectified_already_ ? "the pictures are rectified already"
                                       : "rectifying on the GPU");
    lines.push_back(
        fmt::format("matcher {}, {} disparities, {}x{}, {:.1f} MB of GPU objects", matcher_name_,
                    disparities_, calibration_.rectified.width_px, calibration_.rectified.height_px,
                    matcher_ ? static_cast<double>(matcher_->gpu_bytes()) * 1e-6 : 0.0));
    return lines;
}

}  // namespace vantage

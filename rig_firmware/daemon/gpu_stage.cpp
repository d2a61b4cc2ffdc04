#include "rig_firmware/daemon/gpu_stage.h"

#include <algorithm>
#include <chrono>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/config/gpu_frame_model.h"
#include "common/gl/context/driver_lock.h"

namespace vantage {
namespace {

std::string chosen_matcher(const RigConfig& config) {
    if (config.match.matcher == exact_matcher && config.source.kind != "virtual")
        fail(
            "'matcher = \"exact\"' takes the virtual stage's own depth, and the source is '{}': "
            "leave 'matcher' out or name a real one",
            config.source.kind);
    if (!config.match.matcher.empty()) return config.match.matcher;
    return default_matcher(parse_preset(config.match.preset));
}

/// Returns a copy of the configuration with this matcher preset.
RigConfig with_preset(RigConfig config, const std::string& preset) {
    config.match.preset = preset;
    return config;
}

/// Presets that a configuration allows, best first.
std::vector<std::string> allowed_presets(const RigConfig& config) {
    if (config.match.preset != "auto") return {config.match.preset};
    return {preset_names.begin(), preset_names.end()};
}

/// Returns the size of the pictures that are matched. Throws Error if they would be larger than the
/// colour picture, or if the exact disparity, which has the colour's size, is to have another one.
cv::Size matched_size(const RigConfig& config, const RectifiedStereo& geometry) {
    const int width_px = config.match.width_px;
    const cv::Size picture(geometry.width_px, geometry.height_px);
    if (width_px == 0) return picture;
    if (config.match.matcher == exact_matcher)
        fail(
            "'width_px' in [match] is {}, and the exact disparity has the size of the picture: "
            "leave it out or name a real matcher",
            width_px);
    if (width_px > geometry.width_px)
        fail(
            "'width_px' in [match] is {}, and the rectified picture is {} px wide: matching more "
            "pixels than there are finds nothing; take at most {}",
            width_px, geometry.width_px, geometry.width_px);
    return reduced_size(picture, width_px);
}

MatchSettings match_settings(const RigConfig& config, const RectifiedStereo& geometry) {
    const cv::Size size = matched_size(config, geometry);
    return {.width_px = size.width,
            .height_px = size.height,
            .disparities = config.match.disparities,
            .preset = parse_preset(config.match.preset),
            .fill = config.match.fill,
            .of_stream = config.match.steady};
}

void prepare_intake(CameraIntake& intake, RectifyPass& rectify, const LentPicture& specimen,
                    const std::string& why_not) {
    if (rectify.passes_through())
        intake.prepare(specimen, why_not);
    else
        intake.prepare(specimen, why_not,
                       [&](const RawPlanes& raw) { (void)rectify.rectify(raw); });
}

ShaderLibrary observed_library(ProgramObserver observer) {
    ShaderLibrary library;
    library.observe_programs(std::move(observer));
    return library;
}

std::unique_ptr<Matcher> chosen(const std::string& name, const RigConfig& config,
                                const ShaderLibrary& shaders, const RectifiedStereo& geometry) {
    if (name == exact_matcher) return nullptr;
    return make_matcher(name, shaders, match_settings(config, geometry));
}

}  // namespace

void require_matching(const RigConfig& config, const StereoCalibration& calibration) {
    for (const std::string& preset : allowed_presets(config)) {
        const RigConfig candidate = with_preset(config, preset);
        const std::string name = chosen_matcher(candidate);
        const MatchSettings settings = match_settings(candidate, calibration.rectified);
        if (name == exact_matcher) return;
        require_matcher(name);
        settings.validate();
    }
}

GpuStage::GpuStage(const RigConfig& config, const StereoCalibration& calibration,
                   std::span<const LentPicture> specimens, ProgramObserver observer)
    : info_(GlInfo::query()),
      shaders_(observed_library(std::move(observer))),
      calibration_(calibration),
      disparities_(config.match.disparities),
      rectified_already_(is_identity(calibration, Side::left)),
      left_intake_(context_, shaders_, {calibration.left.width_px, calibration.left.height_px}),
      right_intake_(context_, shaders_, {calibration.right.width_px, calibration.right.height_px}),
      rectify_left_(shaders_, calibration, Side::left),
      rectify_right_(shaders_, calibration, Side::right),
      matched_size_(matched_size(config, calibration.rectified)),
      sends_right_(config.stream.jpeg_quality > 0),
      packer_(config.stream.jpeg_quality, parse_chroma(config.stream.chroma)) {
    info_.require_vantage_minimum();
    prepare_intakes(config.source.buffers, specimens);
    const cv::Size colour_size(calibration.rectified.width_px, calibration.rectified.height_px);
    if (matched_size_ != colour_size)
        for (auto* reduce : {&reduce_left_, &reduce_right_})
            reduce->emplace(shaders_, colour_size, matched_size_);
    if (config.match.steady && config.match.matcher != exact_matcher)
        steady_.emplace(shaders_, matched_size_.width, matched_size_.height);
    choose_matcher(config);
    // The dark frames are not part of the stream.
    right_sent_.reset();
    if (matcher_) matcher_->forget();
    if (steady_) steady_->forget();
    shaders_.observe_programs({});
}

void GpuStage::choose_matcher(const RigConfig& config) {
    const double limit_ms = GpuFrameModel::limit_ms(config.source.rate_hz);
    for (const std::string& preset : allowed_presets(config)) {
        const RigConfig candidate = with_preset(config, preset);
        matcher_name_ = chosen_matcher(candidate);
        matcher_.reset();  // releases its memory before the next matcher allocates
        matcher_ = chosen(matcher_name_, candidate, shaders_, calibration_.rectified);
        // Drivers finish compiling at the first draw call. With software rendering this takes
        // seconds, in which real frames would be lost.
        if (!rectified_already_ || matcher_) match_dark_frame_ms();
        if (config.match.preset != "auto" || !matcher_) return;
        const double frame_ms = std::min(match_dark_frame_ms(), match_dark_frame_ms());
        preset_report_ = fmt::format(
            "preset auto: {}, whose frame takes {:.1f} ms here, and two thirds of a period at "
            "{:.3g} Hz are {:.1f} ms",
            preset, frame_ms, config.source.rate_hz, limit_ms);
        if (frame_ms <= limit_ms) return;
    }
    preset_report_ += ": no preset holds this rate with a margin of a third";
    log_warning("{}; lower 'rate_hz', the size or 'disparities'", preset_report_);
}

double GpuStage::match_dark_frame_ms() {
    StereoFrame dark;
    const cv::Vec4b black(0, 0, 0, 255);
    dark.left = ColourImage(calibration_.left.height_px, calibration_.left.width_px, black);
    dark.right = ColourImage(calibration_.right.height_px, calibration_.right.width_px, black);
    RigFrame unused;
    const MonotonicTime start = MonotonicClock::now();
    rectify_and_match(dark, unused);
    return ms_since(start);
}

std::chrono::nanoseconds GpuStage::frame_limit() const {
    constexpr std::chrono::seconds hung_after(10);
    return info_.is_software ? Fence::no_limit : hung_after;
}

void GpuStage::prepare_intakes(const std::string& buffers, std::span<const LentPicture> specimens) {
    std::string reason = "the cameras do not lend their buffers";
    std::string why_not;
    if (buffers == "copy") why_not = "as configured";
    // Mesa's software renderer lists the extension wherever there is a display driver, and crashes
    // on memory that belongs to another driver.
    else if (info_.is_software)
        why_not = "OpenGL ES is drawn by the processor, which reads no other driver's buffers";
    if (specimens.size() == 2) {
        prepare_intake(left_intake_, rectify_left_, specimens[0], why_not);
        prepare_intake(right_intake_, rectify_right_, specimens[1], why_not);
        reason = left_intake_.imports() ? right_intake_.reason() : left_intake_.reason();
        intake_report_ = reason.empty()
                             ? "the GPU reads the cameras' buffers (dma-buf): no picture is copied"
                             : fmt::format("every picture is copied to the GPU: {}", reason);
    }
    if (buffers == "import" && !reason.empty())
        fail(
            "'buffers = \"import\"' in [source] is not possible here: {}; \"auto\" copies pictures "
            "to the GPU instead",
            reason);
}

CameraIntake::Counts GpuStage::lent_pictures() const {
    const CameraIntake::Counts &left = left_intake_.counts(), &right = right_intake_.counts();
    return {.imported = left.imported + right.imported, .copied = left.copied + right.copied};
}

RigFrame GpuStage::process(StereoFrame frame) {
    const DriverLock turn(context_.driver());
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
    if (result.packed_colour.empty()) packer_.pack(result);
    // With GPU timers, packing runs beside the GPU and does not count as matching time. With CPU
    // timers, packing would have to wait for the matcher to be timed.
    result.times.match_ms =
        matcher_ && match_timer_.is_of_gpu()
            ? static_cast<float>(match_timer_.wait_ms())
            : std::max(0.0F, static_cast<float>(ms_since(start)) - result.times.rectify_ms -
                                 result.times.pack_ms);

    result.synchronized = frame.synchronized;
    result.trigger_index = frame.trigger_index;
    result.exposure = frame.exposure;
    result.calibration_id = calibration_.id;
    result.geometry = calibration_.rectified;
    result.world_from_camera = calibration_.world_from_rectified_left();
    result.place_is_assumed = calibration_.place_is_assumed;
    result.max_disparity_px = static_cast<float>(disparities_);
    return result;
}

void GpuStage::rectify_and_match(const StereoFrame& frame, RigFrame& result) {
    rectify_timer_.begin();
    const auto rectified = [](RectifyPass& pass, CameraIntake& intake, const ColourImage& picture,
                              const std::optional<LentPicture>& lent) -> const Texture& {
        if (!lent) return pass.rectify(intake.bring(picture));
        return pass.passes_through() ? pass.rectify(intake.bring(*lent))
                                     : pass.rectify(intake.planes(*lent));
    };
    const Texture& left = rectified(rectify_left_, left_intake_, frame.left, frame.lent_left);
    const Texture* right = nullptr;
    if (matcher_) right = &rectified(rectify_right_, right_intake_, frame.right, frame.lent_right);
    rectify_timer_.end();
    const bool is_right_due = right && sends_right_ &&
                              (!right_sent_ || frame.exposure < *right_sent_ ||
                               frame.exposure - *right_sent_ >= right_period);
    if (is_right_due) {
        right_readback_.begin(*right);
        right_sent_ = frame.exposure;
    }
    const bool has_colour = rectified_already_ && !frame.lent_left;
    if (!has_colour) colour_readback_.begin(left);
    const bool is_timed = matcher_ && match_timer_.is_of_gpu();
    if (is_timed) match_timer_.begin();
    const Texture* disparity = nullptr;
    if (matcher_) {
        const Texture& matched_left = reduce_left_ ? reduce_left_->reduce(left) : left;
        disparity =
            &matcher_->match(matched_left, reduce_right_ ? reduce_right_->reduce(*right) : *right);
        if (steady_) disparity = &steady_->run(*disparity, matched_left);
    }
    if (is_timed) match_timer_.end();
    // All GPU work is queued; the first image that arrives is packed while the GPU matches.
    if (disparity) disparity_readback_.begin(*disparity);
    result.colour = has_colour ? frame.left : ColourImage(colour_readback_.take({}, frame_limit()));
    if (is_right_due) result.right = ColourImage(right_readback_.take({}, frame_limit()));
    packer_.pack(result);
    if (disparity) result.disparity = disparity_readback_.take({}, frame_limit());
    result.times.rectify_ms = static_cast<float>(rectify_timer_.wait_ms());
}

std::vector<std::string> GpuStage::report() const {
    std::vector<std::string> lines;
    for (const EglAttempt& attempt : context_.attempts())
        lines.push_back(fmt::format("EGL {}: {}", attempt.platform, attempt.outcome));
    lines.push_back(fmt::format("GPU: {}, {}", info_.renderer, info_.version));
    if (!intake_report_.empty()) lines.push_back(intake_report_);
    if (!preset_report_.empty()) lines.push_back(preset_report_);
    lines.push_back(rectified_already_ ? "the pictures are rectified already"
                                       : "rectifying on the GPU");
    lines.push_back(
        fmt::format("matcher {}, {} disparities, {}x{}, {:.1f} MB of GPU objects", matcher_name_,
                    disparities_, matched_size_.width, matched_size_.height,
                    matcher_ ? static_cast<double>(matcher_->gpu_bytes()) * 1e-6 : 0.0));
    return lines;
}

}  // namespace vantage

#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/config/rig_config.h"
#include "common/gl/context/egl_context.h"
#include "common/gl/context/limits.h"
#include "common/gl/objects/gpu_timer.h"
#include "common/gl/objects/readback.h"
#include "common/gl/shader_library.h"
#include "common/rectification/rectify_pass.h"
#include "common/wire/frame_codec.h"
#include "rig_firmware/capture/camera_intake.h"
#include "rig_firmware/capture/stereo_source.h"
#include "rig_firmware/stereo/disparity/temporal_pass.h"
#include "rig_firmware/stereo/features/reduce_pass.h"
#include "rig_firmware/stereo/matcher.h"

namespace vantage {

/// Time between two right images in the stream. Static scenery changes slowly, so two per second
/// are enough.
inline constexpr std::chrono::milliseconds right_period{500};

/// Throws Error if the matcher, preset or size of the configuration does not exist, or if the
/// source cannot feed the matcher. Needs no GPU.
void require_matching(const RigConfig& config, const StereoCalibration& calibration);

/// GPU stage of the rig's pipeline: upload, rectify, match and read back. It owns its GL context;
/// create, use and destroy it on one thread.
class GpuStage {
  public:
    /// `specimens`: sample buffers that the source lends, left and right; empty if it lends none.
    /// Compiles all shaders, which takes from a second to some minutes, and reports each shader to
    /// `observer`. Throws Error if there is no OpenGL ES, if the matcher or calibration of the
    /// configuration does not fit, or if it requires a buffer import that is not possible.
    GpuStage(const RigConfig& config, const StereoCalibration& calibration,
             std::span<const LentPicture> specimens = {}, ProgramObserver observer = {});

    /// Rectifies and matches one stereo frame, and packs its colour while the GPU matches. Every
    /// right_period it packs the right image too, which hosts use to match the background. Fills in
    /// image, disparity, geometry, pose and the times of these steps. Throws ContextLost if the GPU
    /// was reset or does not finish; the caller then has to create a new stage.
    RigFrame process(StereoFrame frame);

    /// Number of images so far that were imported from or copied out of lent buffers, both cameras
    /// together.
    CameraIntake::Counts lent_pictures() const;

    /// Lines for the start-up report: how the context was created, the renderer and the matcher.
    std::vector<std::string> report() const;

  private:
    /// Time after which a frame counts as hung on the GPU. Software rendering has no limit.
    std::chrono::nanoseconds frame_limit() const;
    void rectify_and_match(const StereoFrame& frame, RigFrame& result);
    /// Creates the matcher with the best preset whose frames take at most two thirds of a period.
    void choose_matcher(const RigConfig& config);
    /// Matches black images, so that drivers finish compiling their programs. Returns the time it
    /// took in milliseconds.
    double match_dark_frame_ms();
    void prepare_intakes(const std::string& buffers, std::span<const LentPicture> specimens);

    EglContext context_;
    GlInfo info_;
    ShaderLibrary shaders_;
    StereoCalibration calibration_;
    std::string matcher_name_;
    int disparities_;
    bool rectified_already_;
    CameraIntake left_intake_, right_intake_;
    std::string preset_report_;  ///< how the preset was chosen; empty if the configuration names it
    std::string intake_report_;  ///< empty if the source lends no buffers
    RectifyPass rectify_left_, rectify_right_;
    cv::Size matched_size_;
    std::optional<ReducePass> reduce_left_, reduce_right_;  ///< if less than the colour is matched
    GpuTimer rectify_timer_, match_timer_;
    Readback colour_readback_, right_readback_, disparity_readback_;
    bool sends_right_;                   ///< false with lossless colour
    std::optional<TaiTime> right_sent_;  ///< exposure of the last right image that was packed
    ColourPacker packer_;
    std::optional<TemporalPass> steady_;
    std::unique_ptr<Matcher>
        matcher_;  ///< null if the virtual stage supplies the disparity ("exact")
};

}  // namespace vantage

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
#include "rig_firmware/stereo/matcher.h"

namespace vantage {

/// Between two right pictures that travel. Of what stands still a few are enough.
inline constexpr std::chrono::milliseconds right_period{500};

/// Throws Error where the configuration asks for a matcher, preset or size that there is not, or
/// for a matcher that the source does not serve. Needs no GPU.
void require_matching(const RigConfig& config, const StereoCalibration& calibration);

/// The GPU's part of the road: upload, rectify, match, read back. Owns its GL context; made, used
/// and destroyed on one thread.
class GpuStage {
  public:
    /// `specimens`: buffers such as the source lends its pictures in, left and right; none: it
    /// lends none. Compiles all shaders, which takes from a second to some minutes, and tells
    /// `observer` of each. Throws Error if there is no OpenGL ES, the config's matcher or
    /// calibration does not fit, or it asks for an import that is not possible.
    GpuStage(const RigConfig& config, const StereoCalibration& calibration,
             std::span<const LentPicture> specimens = {}, ProgramObserver observer = {});

    /// Rectifies and matches one instant, and packs its colour while the GPU matches; the right
    /// picture's too, every right_period, by which hosts match the set. Fills picture, disparity,
    /// geometry, pose and the times of these steps. Throws ContextLost if the GPU was reset or does
    /// not finish: a new stage has to be made then.
    RigFrame process(StereoFrame frame);

    /// Lent pictures of both sides so far.
    CameraIntake::Counts lent_pictures() const;

    /// Lines for the start-up report: how the context was had, the renderer, the matcher.
    std::vector<std::string> report() const;

  private:
    /// How long a frame may take before the GPU counts as hung; a processor that draws may take any
    /// time.
    std::chrono::nanoseconds frame_limit() const;
    void rectify_and_match(const StereoFrame& frame, RigFrame& result);
    /// Makes the matcher of the best preset whose frames take at most two thirds of a period.
    void choose_matcher(const RigConfig& config);
    /// Matches black pictures, which has drivers finish their programs. Returns what it took.
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
    std::string preset_report_;  ///< how the preset was chosen; empty: it was given
    std::string intake_report_;  ///< empty: the source lends no pictures
    RectifyPass rectify_left_, rectify_right_;
    GpuTimer rectify_timer_, match_timer_;
    Readback colour_readback_, right_readback_, disparity_readback_;
    bool sends_right_;                   ///< not beside lossless colour
    std::optional<TaiTime> right_sent_;  ///< exposure of the last right picture that was packed
    ColourPacker packer_;
    std::optional<TemporalPass> steady_;
    std::unique_ptr<Matcher> matcher_;  ///< null: the virtual stage's own disparity ("exact")
};

}  // namespace vantage

#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>

#include "common/virtual_stage/virtual_rig.h"
#include "common/virtual_stage/virtual_stage.h"
#include "common/wire/codec/chroma.h"
#include "host_app/views/depth_view.h"
#include "rig_firmware/stereo/disparity/temporal_pass.h"
#include "rig_firmware/stereo/features/reduce_pass.h"
#include "rig_firmware/stereo/matcher.h"

namespace vantage {

/// An ideal rig at its usual distance from the virtual stage's middle.
StereoCalibration rig_at(double azimuth_deg, cv::Size size);

/// The view of a rig's left camera.
VirtualView camera_of(const StereoCalibration& rig);

/// A rig of the virtual stage, with all that its daemon would do to a pair, in this process.
class MatchingRig {
  public:
    struct Settings {
        cv::Size size{320, 240};
        int match_width_px = 0;  ///< of the pair that is matched; 0: that of `size`
        int disparities = 64;
        MatchPreset preset = MatchPreset::quality;
        double noise_sigma = 1;  ///< of the sensors, grey levels
        int jpeg_quality = 0;    ///< 1..100: colour goes through a JPEG; 0: as it is seen
        Chroma chroma = Chroma::quarter;
    };
    MatchingRig(const ShaderLibrary& library, double azimuth_deg, std::uint64_t seed,
                const Settings& settings);

    void film(VirtualStage& stage, std::chrono::nanoseconds stage_time, std::uint64_t instant);

    StageCamera camera() const;

    /// What was filmed last, with the depth that the rig's own matcher found or the exact one.
    DepthView view(bool with_own_depth) const;

  private:
    /// `disparity` is in px of its own width.
    DepthImage depth_of(const cv::Mat& disparity) const;

    StereoCalibration calibration_;
    VirtualRig rig_;
    Texture left_, right_;
    cv::Size matched_size_;
    struct Reduce {
        ReducePass left, right;
        Reduce(const ShaderLibrary& library, cv::Size from, cv::Size to)
            : left(library, from, to), right(library, from, to) {}
    };
    std::optional<Reduce> reduce_;  ///< if fewer pixels are matched than are shown
    std::unique_ptr<Matcher> matcher_;
    TemporalPass steady_;
    int jpeg_quality_;
    Chroma chroma_;
    DepthView view_;
    std::optional<std::chrono::nanoseconds> right_sent_;  ///< stage time
    DepthImage own_m_, exact_m_;
};

}  // namespace vantage

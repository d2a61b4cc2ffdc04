#pragma once

#include <optional>

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "common/gl/objects/texture.h"
#include "rig_firmware/stereo/features/luma_pass.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// Rows that the matching passes after FeaturePass read: all, or one of two, as
/// HalvedCostSamples::one takes them.
enum class FeatureRows { all, one_of_two };

/// What the matching passes compare: feature words of both pictures.
/// If the right picture lies up to two whole rows too low or too high, its words are those of the
/// picture put right: a knock to a camera must not cost the depth until it is calibrated again.
class FeaturePass {
  public:
    /// Of a stream, rows are compared in one frame of so many: cameras move seldom.
    static constexpr int row_shift_period_frames = 16;

    /// disparities: the search range, in which rows are compared.
    FeaturePass(const ShaderLibrary& library, const StereoLayout& layout, int disparities,
                PictureKind kind = PictureKind::single, FeatureRows rows = FeatureRows::all);

    void run(PassProfiler& profiler, const LumaPass& luma);
    /// The next pair does not follow the last one: its rows are compared.
    void forget() { frames_until_comparison_ = 0; }

    const Buffer& left_features() const { return left_features_; }
    const Buffer& right_features() const { return right_features_; }
    const StereoLayout& layout() const { return layout_; }
    std::size_t gpu_bytes() const;

  private:
    void compare_rows();
    void features(Program& program, const Buffer& luma, const Buffer& words);

    StereoLayout layout_;
    int disparities_;
    PictureKind kind_;
    int frames_until_comparison_ = 0;
    FeatureRows rows_;
    std::optional<Program> all_rows_program_;  ///< where rows_ is even
    Program features_program_, shifted_program_, clear_program_, votes_program_;
    Buffer left_features_, right_features_, votes_;
};

}  // namespace vantage

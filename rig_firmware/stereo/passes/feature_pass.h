#pragma once

#include "common/gl/buffer.h"
#include "common/gl/program.h"
#include "common/gl/texture.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/passes/feature_reference.h"
#include "rig_firmware/stereo/passes/luma_pass.h"
#include "rig_firmware/stereo/passes/stereo_layout.h"

namespace vantage {

/// What the matching passes look at: feature words of both pictures, permeability of the left one.
/// If the right picture lies up to two whole rows too low or too high, its words are those of the
/// picture put right: a knock to a camera must not cost the depth until it is calibrated again.
class FeaturePass {
  public:
    /// disparities: the search range, in which rows are compared; 0: rows lie as they should.
    FeaturePass(const ShaderLibrary& library, const StereoLayout& layout, double sigma,
                int disparities);

    void run(PassProfiler& profiler, const LumaPass& luma);
    /// The feature words alone.
    void run_words(PassProfiler& profiler, const LumaPass& luma);

    const Buffer& left_features() const { return left_features_; }
    const Buffer& right_features() const { return right_features_; }
    /// Five sums, of shifts by -2 .. 2 rows, see row_shift_votes.comp.
    const Buffer& row_shift_votes() const { return votes_; }
    /// From the left neighbour: four pixels of a row a word, a byte each of 0..15 sixteenths.
    const Buffer& permeability_along() const { return along_; }
    /// From the upper neighbour: four rows of a column a word, stride_px words a group of rows.
    const Buffer& permeability_down() const { return down_; }
    const StereoLayout& layout() const { return layout_; }
    std::size_t gpu_bytes() const;

  private:
    void features(Program& program, const Buffer& luma, const Buffer& words);

    StereoLayout layout_;
    int disparities_;
    Program features_program_, shifted_program_, clear_program_, votes_program_, median_program_,
        permeability_program_;
    Buffer guide_, left_features_, right_features_, along_, down_, table_, votes_;
};

}  // namespace vantage

#pragma once

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// Shape of the costs around a minimum, which decides how the sub-pixel position is computed from
/// the three lowest costs.
enum class Valley {
    sharp,  ///< two straight lines of equal steepness, as absolute differences give
    flat,   ///< HalvedCostPass's, which takes the least of three disparities: flat, then rising, so
            ///< that straight lines would meet too far from the middle
};

/// Left-right consistency, sub-pixel position and confidence. The right picture's disparity is what
/// the best of the left pixels that claim a right pixel says; a left pixel whose claim lost by more
/// than one pixel of disparity is occluded or mismatched.
class LeftRightPass {
  public:
    LeftRightPass(const ShaderLibrary& library, const StereoLayout& layout,
                  Valley valley = Valley::sharp);

    /// winners and weight in PermPass's form; no weight where costs compare as they are.
    void run(PassProfiler& profiler, const Buffer& winners, const Buffer* weight);

    /// uint a pixel: disparity in 1/32 px (0 = unknown) | confidence << 16.
    const Buffer& disparity() const { return disparity_; }
    /// As large as disparity() and of no worth once run() is done: others may use it until the
    /// next.
    const Buffer& scratch() const { return claims_; }
    std::size_t gpu_bytes() const { return claims_.bytes() + disparity_.bytes(); }

  private:
    StereoLayout layout_;
    Program weighted_, unweighted_;
    Buffer claims_, disparity_;
};

}  // namespace vantage

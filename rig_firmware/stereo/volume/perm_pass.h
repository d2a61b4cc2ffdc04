#pragma once

#include <optional>

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "rig_firmware/stereo/features/feature_pass.h"
#include "rig_firmware/stereo/features/permeability_pass.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/lane_mapping.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// Largest cost of PermOutput::costs for two semi-global paths. Four paths need smaller ones,
/// because the sum of three has to fit a byte.
inline constexpr int max_perm_code = 80;

/// What PermPass leaves.
enum class PermOutput {
    winners,  ///< the best disparity; the cost volume is only ever a slab of 16 disparities
    costs,    ///< a cost of a byte a disparity, divided by the pixel's weight, for SgmPass
};

/// Where PermPass has the matching costs from.
enum class PermCosts {
    found,  ///< from feature words, as it goes
    given,  ///< in costs() before run(): 16 bytes a pixel in the order of perm_common.glsl, pixels
            ///< in blocks, slab after slab; of PermOutput::costs, which replace them
};

/// Cost, permeability aggregation and winner takes all over the whole search range. Aggregation
/// does not mix disparities, so that slabs follow one another and only the winner so far stays.
/// After C. Cigla, A. A. Alatan, "Information permeability for stereo matching", Signal Processing:
/// Image Communication 28 (2013).
class PermPass {
  public:
    /// `most_code`: the largest cost that PermOutput::costs leaves, where every cost is the
    /// largest. `lanes` changes the time that it takes, and no bit of what it leaves.
    PermPass(const ShaderLibrary& library, const StereoLayout& layout, int disparities,
             PermOutput output = PermOutput::winners, PermCosts costs = PermCosts::found,
             int most_code = max_perm_code, LaneMapping lanes = lane_mapping_here());

    void run(PassProfiler& profiler, const FeaturePass& features,
             const PermeabilityPass& permeability);
    /// Of PermCosts::given.
    void run(PassProfiler& profiler, const PermeabilityPass& permeability);

    /// uvec2 a pixel in blocks (StereoLayout), see winner_takes_all.glsl; of PermOutput::winners.
    const Buffer& winners() const { return output_; }
    /// 16 bytes a pixel, pixels in blocks, slab after slab; of PermOutput::costs.
    const Buffer& costs() const { return output_; }
    /// uint a pixel: what a pixel's sums are divided by before pixels are compared; of
    /// PermOutput::winners.
    const Buffer& weight() const { return weight_; }
    /// Of no worth once run() is done: others may use them until the next run. 32 (of
    /// PermOutput::costs) and 16 bytes a
    /// pixel.
    const Buffer& large_scratch() const { return down_; }
    const Buffer& small_scratch() const { return volume_; }
    std::size_t volume_bytes() const;
    std::size_t gpu_bytes() const;

  private:
    void run(PassProfiler& profiler, const FeaturePass* features,
             const PermeabilityPass& permeability);
    void run_line_pass(Program& program, int lines, int first_disparity);

    StereoLayout layout_;
    int disparities_;
    PermOutput kind_;
    LaneMapping lanes_;
    Program rows_, full_columns_, last_columns_, weight_rows_, weight_columns_;
    Buffer volume_, down_, output_, weight_;
};

}  // namespace vantage

#pragma once

#include <optional>

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "rig_firmware/stereo/features/feature_pass.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/dispatch_parts.h"
#include "rig_firmware/stereo/volume/lane_mapping.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// Penalties of path aggregation.
struct SgmSettings {
    int p1 = 4;           ///< for a step of one disparity
    int p2 = 20;          ///< for any larger step
    bool columns = true;  ///< four paths; false: only the two along the row

    /// Largest input cost: sums of three paths must fit a byte, and one path's value seven bits.
    int most_cost() const { return columns ? 85 - p2 : 127 - p2; }
};

/// Matching cost of every pixel and disparity, as SgmPass takes it.
class SgmCostPass {
  public:
    /// `scale`: what a feature cost of 0..31 is multiplied by.
    SgmCostPass(const ShaderLibrary& library, const StereoLayout& layout, int disparities,
                int scale);

    void run(PassProfiler& profiler, const FeaturePass& features);

    /// 16 bytes a pixel, pixels in blocks (StereoLayout), slab after slab.
    const Buffer& costs() const { return costs_; }

  private:
    StereoLayout layout_;
    int disparities_;
    Program program_;
    Buffer costs_;
};

/// Path aggregation and winner takes all over a whole cost volume. H. Hirschmueller, "Stereo
/// processing by semiglobal matching and mutual information", PAMI 30 (2008).
class SgmPass {
  public:
    /// lanes and max_operations (of one dispatch) change the time that it takes, and no bit of the
    /// result.
    SgmPass(const ShaderLibrary& library, const StereoLayout& layout, int disparities,
            const SgmSettings& settings, LaneMapping lanes = lane_mapping_here(),
            double max_operations = max_dispatch_operations);
    /// Keeps its sums in `scratch` and its winners in `for_winners` if they fit: buffers that
    /// outlive this and hold nothing of worth from run() on, until the winners were read.
    SgmPass(const ShaderLibrary& library, const StereoLayout& layout, int disparities,
            const SgmSettings& settings, const Buffer& scratch, const Buffer& for_winners,
            LaneMapping lanes = lane_mapping_here());

    /// costs: bytes in SgmCostPass's form, at most SgmSettings::most_cost().
    void run(PassProfiler& profiler, const Buffer& costs);

    /// In PermPass's form; costs of all pixels compare as they are.
    const Buffer& winners() const { return own_winners_ ? *own_winners_ : *for_winners_; }
    std::size_t volume_bytes() const { return own_sums_ ? own_sums_->bytes() : 0U; }
    std::size_t gpu_bytes() const {
        return volume_bytes() + (own_winners_ ? own_winners_->bytes() : 0U) +
               (paths_ ? paths_->bytes() : 0U);
    }

  private:
    SgmPass(const ShaderLibrary& library, const StereoLayout& layout, int disparities,
            const SgmSettings& settings, const Buffer* scratch, const Buffer* for_winners,
            LaneMapping lanes, double max_operations);
    /// Most lines that one dispatch walks side by side.
    int path_lines() const;

    StereoLayout layout_;
    int disparities_;
    SgmSettings settings_;
    double max_operations_;
    int sum_rows_;
    bool rows_in_memory_, columns_in_memory_;  ///< see sgm_path_narrow.comp
    Program rows_;
    Program columns_;
    std::optional<Buffer> own_sums_, own_winners_, paths_;
    const Buffer *scratch_, *for_winners_;
};

}  // namespace vantage

#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// The share of a sum, in sixteenths, that passes a step of 0..255 levels of the guide (that of
/// luma plus half of that of colour): 16 exp(-step / sigma), at most 15.
using PermeabilityTable = std::array<std::uint32_t, 256>;
PermeabilityTable permeability_table(double sigma);

/// The image whose steps stop the sums.
enum class PermeabilityGuide {
    median,  ///< the 3x3 median of the picture, which takes its noise out and leaves its edges
    plain,   ///< the picture itself: where it was halved, most noise is out of it already
};

/// How much of a sum passes from each pixel of a picture to the next, along rows and down columns.
class PermeabilityPass {
  public:
    /// sigma: grey levels of the guide over which a sum falls to 1/e.
    PermeabilityPass(const ShaderLibrary& library, const StereoLayout& layout, double sigma,
                     PermeabilityGuide guide = PermeabilityGuide::median);

    /// luma: in LumaPass's form.
    void run(PassProfiler& profiler, const Buffer& luma);

    /// From the left neighbour: four pixels of a row a word, a byte each of 0..15 sixteenths.
    const Buffer& along() const { return along_; }
    /// From the upper neighbour: four rows of a column a word, stride_px words a group of rows.
    const Buffer& down() const { return down_; }
    std::size_t gpu_bytes() const {
        return (medians_ ? medians_->bytes() : 0U) + along_.bytes() + down_.bytes() +
               table_.bytes();
    }

  private:
    StereoLayout layout_;
    Program median_program_, permeability_program_;
    std::optional<Buffer> medians_;
    Buffer along_, down_, table_;
};

}  // namespace vantage

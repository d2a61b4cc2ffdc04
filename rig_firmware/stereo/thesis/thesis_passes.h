#pragma once

#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"
#include "rig_firmware/stereo/thesis/cost_volume.h"
#include "rig_firmware/stereo/thesis/storage_pass.h"

namespace vantage::thesis {

/// Copies an rgba8 texture into a storage buffer, a word a pixel, as ColourImage lies in memory.
class PictureWordsPass {
  public:
    PictureWordsPass(const ShaderLibrary& library, cv::Size size);
    void run(const Texture& picture, const Buffer& words);
    PassCost cost() const { return pass_cost(8 * pass_.pixels(), 8 * pass_.pixels()); }

  private:
    StoragePass pass_;
};

/// One iteration of symmetric neighbourhood filtering (Harwood et al. 1987): edges stay sharp,
/// texture noise goes. Buffers hold a word a pixel.
class SnfPass {
  public:
    SnfPass(const ShaderLibrary& library, cv::Size size);
    void run(const Buffer& source, const Buffer& filtered);
    PassCost cost() const { return pass_cost(8 * pass_.pixels(), 130 * pass_.pixels()); }

  private:
    StoragePass pass_;
};

/// The binary discontinuity map: the greatest gradient of the three channels, thresholded, towards
/// each of the four neighbours. Kept per side, since aggregation asks which neighbours lie beyond.
/// `picture` and the map hold a word a pixel; bits as in Discontinuity.
class DiscontinuityPass {
  public:
    DiscontinuityPass(const ShaderLibrary& library, cv::Size size);
    void run(const Buffer& picture, int threshold, const Buffer& discontinuities);
    PassCost cost() const { return pass_cost(8 * pass_.pixels(), 60 * pass_.pixels()); }

  private:
    StoragePass pass_;
};

/// The cost of every disparity hypothesis: absolute difference of left (x, y) and right (x - d, y).
class HypothesesPass {
  public:
    HypothesesPass(const ShaderLibrary& library, cv::Size size, int disparities);
    /// left, right: a word a pixel. Fills `slices` slices of `costs` (cost_volume.h) with the
    /// disparities from first_disparity on, a multiple of disparities_per_slice.
    void run(const Buffer& left, const Buffer& right, int first_disparity, int slices,
             const Buffer& costs);
    PassCost cost(int slices) const;

  private:
    StoragePass pass_;
    int disparities_;
};

/// One pass of gradient-guided aggregation (Gong & Yang 2005, as the thesis describes it): a mean
/// over the 3x3 neighbourhood whose weights come from a table by the discontinuities around, so
/// that neighbours beyond one are left out. Applied repeatedly.
class AggregationPass {
  public:
    AggregationPass(const ShaderLibrary& library, cv::Size size);
    /// Cost volumes as in cost_volume.h; `discontinuities` as DiscontinuityPass writes them.
    void run(const Buffer& costs, const Buffer& discontinuities, int slices,
             const Buffer& aggregated);
    PassCost cost(int slices) const;

  private:
    StoragePass pass_;
};

/// Winner takes all. The volume may come in batches of slices; `keys` (a word a pixel) keeps
/// (cost << 8) | disparity of the cheapest hypothesis so far.
class WinnerPass {
  public:
    WinnerPass(const ShaderLibrary& library, cv::Size size);
    /// costs: `slices` slices (cost_volume.h) from first_disparity on; 0 starts afresh.
    void run(const Buffer& costs, int first_disparity, int slices, const Buffer& keys);
    PassCost cost(int slices) const;

  private:
    StoragePass pass_;
};

/// Turns the winners into the picture that every matcher delivers. A winner that points beyond the
/// right picture's edge has no match: it is filled from the next match to its right (on that side
/// of the picture only background can lie hidden), or left unknown.
class DisparityPass {
  public:
    DisparityPass(const ShaderLibrary& library, cv::Size size, bool fill);
    /// keys: of WinnerPass. The result is valid until the next run.
    const Texture& run(const Buffer& keys);
    PassCost cost() const;
    std::size_t gpu_bytes() const { return disparity_.bytes(); }

  private:
    FullscreenPass pass_;
    Texture disparity_;
    Framebuffer target_;
};

}  // namespace vantage::thesis

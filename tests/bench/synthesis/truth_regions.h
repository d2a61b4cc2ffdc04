#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/image/image.h"
#include "common/virtual_stage/virtual_stage.h"

namespace vantage {

/// Parts of a picture of the virtual stage that fail for reasons of their own. Every pixel is in
/// one.
enum class TruthRegion {
    performers,  ///< within them
    edges,       ///< of performers, a band of 5 px
    beside,      ///< the background up to 12 px beside them
    thin,        ///< what of the background an opening of 7x7 px takes away, and 1 px around
    rims,        ///< the background's depth edges, a band of 5 px
    surfaces     ///< what is left
};
inline constexpr std::array all_truth_regions{TruthRegion::performers, TruthRegion::edges,
                                              TruthRegion::beside,     TruthRegion::thin,
                                              TruthRegion::rims,       TruthRegion::surfaces};

const char* words_of(TruthRegion region);
/// Throws Error for what is none, with those there are.
TruthRegion parse_truth_region(const std::string& text);

/// The parts of what one camera sees, which stands still.
class TruthRegions {
  public:
    TruthRegions(VirtualStage& stage, const StageCamera& camera);

    /// The background's exact depth.
    const DepthImage& background_depth_m() const { return background_depth_m_; }
    /// Where performers are, by this instant's exact depth.
    cv::Mat1b performers(const DepthImage& depth_m) const;
    /// A TruthRegion a pixel.
    cv::Mat1b of(const DepthImage& depth_m) const;

  private:
    DepthImage background_depth_m_;  ///< the farthest at any time: performers walk about
    cv::Mat1b thin_, rims_;
};

/// A band of `width_px` around the edges of a mask.
cv::Mat1b band_of(const cv::Mat1b& mask, int width_px);

}  // namespace vantage

#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "host_app/gallery/foreground_preparer.h"

namespace vantage {

/// A connected part of a rig's matte: one person, or several who occlude each other.
struct CutOut {
    cv::Point2d foot_px;  ///< centre of its lowest rows
    int area_px = 0;
};

/// Returns at most `most` parts of a matte, the largest first, without specks. Sets `labels` to the
/// number of each pixel's part, counted from 1; 0 = none.
std::vector<CutOut> cut_outs(const cv::Mat1b& matte, std::size_t most, cv::Mat1b& labels);

/// A ForegroundInstant with the connected parts of every rig's foreground.
struct TourInstant final : InstantExtra {
    struct Labels {
        std::optional<Texture> numbers;  ///< r8, in the image's size
    };
    struct Rig {
        std::vector<CutOut> cut_outs;
        std::shared_ptr<const Labels> labels;
    };
    std::shared_ptr<const Instant> performers;  ///< its extra is a ForegroundInstant
    std::vector<Rig> rigs;                      ///< in the same order
};

/// Reads the mattes back from the GPU and splits them into connected parts.
class TourPreparer final : public InstantPreparer {
  public:
    static constexpr std::size_t most_cut_outs = 8;

    explicit TourPreparer(const ShaderLibrary& library) : performers_(library) {}

    void take(std::span<const DepthView> views, double dt_s) override;
    std::shared_ptr<const Instant> prepare(const VirtualView& target,
                                           const PrepareLevel& level) override;

  private:
    ForegroundPreparer performers_;
    RecyclePool<TourInstant::Labels> labels_;
    std::shared_ptr<const Instant> instant_;  ///< null: not made yet from what was taken
};

}  // namespace vantage

#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "host_app/gallery/foreground_preparer.h"

namespace vantage {

/// A part of a rig's matte that hangs together: a performer, or some who hide each other.
struct CutOut {
    cv::Point2d foot_px;  ///< the middle of where it ends at the bottom
    int area_px = 0;
};

/// The parts of a matte from the largest on, at most `most`, without specks; `labels` becomes the
/// number of each pixel's part, from 1 on, 0 = none.
std::vector<CutOut> cut_outs(const cv::Mat1b& matte, std::size_t most, cv::Mat1b& labels);

/// PerformerInstant with every rig's performers told apart.
struct TourInstant final : InstantExtra {
    struct Labels {
        std::optional<Texture> numbers;  ///< r8, of the picture's size
    };
    struct Rig {
        std::vector<CutOut> cut_outs;
        std::shared_ptr<const Labels> labels;
    };
    std::shared_ptr<const Instant> performers;  ///< its extra is a PerformerInstant
    std::vector<Rig> rigs;                      ///< as there
};

/// Reads mattes back to tell performers apart.
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
    std::shared_ptr<const Instant> instant_;  ///< null: not yet made of what was taken
};

}  // namespace vantage

#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "host_app/live/live_report.h"

namespace vantage {

/// The stages of a frame's way, in its order.
enum class Stage {
    capture,
    rectify,
    match,
    pack,
    network,
    decode,
    upload,
    render,
    readback,
    encode
};
inline constexpr std::size_t stage_count = 10;
const char* stage_name(Stage stage);

/// How long the stages took.
class StageTimes {
  public:
    void add(Stage stage, double ms);
    /// Every stage, in order; those that nobody added to have no samples.
    std::vector<StageTime> summary() const;

  private:
    std::array<PercentileRecorder, stage_count> recorders_;
};

}  // namespace vantage

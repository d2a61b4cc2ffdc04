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

/// How long the stages took, all samples and the latest one.
class StageTimes {
  public:
    void add(Stage stage, double ms);
    double latest_ms(Stage stage) const { return latest_ms_[index(stage)]; }
    /// Every stage, with those times that somebody else measured put in by the caller.
    std::vector<StageTime> summary() const;

  private:
    static std::size_t index(Stage stage) { return static_cast<std::size_t>(stage); }

    std::array<PercentileRecorder, stage_count> recorders_;
    std::array<double, stage_count> latest_ms_{};
};

}  // namespace vantage

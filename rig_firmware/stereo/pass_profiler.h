#pragma once

#include <cstddef>
#include <functional>
#include <string_view>
#include <vector>

#include "common/gl/objects/gpu_timer.h"
#include "rig_firmware/stereo/matcher.h"

namespace vantage {

/// What one run of a pass asks of the GPU, by its own accounting.
struct PassCost {
    std::size_t bytes_moved = 0;  ///< read + written, each texel that is needed counted once
    /// Instructions of one lane, summed over all lanes, as Mesa's compiler for a Raspberry Pi 5
    /// emits them (docs/results/v3d.md).
    double operations = 0;
};

/// Keeps a matcher's book for Matcher::passes(): every pass of a frame runs through run(). Switched
/// off it costs nothing; switched on, every pass is timed by itself, which keeps the GPU from
/// overlapping passes, so that their sum is a little more than a frame takes.
class PassProfiler {
  public:
    void set_enabled(bool on) { enabled_ = on; }

    /// Forgets the last frame.
    void begin_frame();
    /// Calls `pass`, which issues the GL commands of one pass. Runs of one name are summed.
    void run(std::string_view name, const PassCost& cost, const std::function<void()>& pass);
    /// Waits for the times of this frame, if profiling is on.
    void end_frame();

    /// Of the last frame, in the order of each name's first run; empty unless profiling was on.
    const std::vector<PassReport>& reports() const { return reports_; }

  private:
    bool enabled_ = false;
    std::vector<PassReport> reports_;
    std::vector<GpuTimer> timers_;  ///< one for every run of a frame, kept for the next frame
    std::vector<std::size_t> report_of_run_;
};

}  // namespace vantage

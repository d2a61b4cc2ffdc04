#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/base/percentiles.h"
#include "common/sync/sync_bar.h"
#include "rig_firmware/trigger/bar_lines.h"

namespace vantage {

struct BarStatus {
    std::uint64_t shown = 0;    ///< steps
    std::uint64_t skipped = 0;  ///< steps that a late wake-up passed over
    Percentiles lateness_us;    ///< of the changes behind their time
};

/// Counts the steps of a bar on a thread of its own, by CLOCK_TAI: absolute deadlines, SCHED_FIFO
/// and locked memory as far as permitted, a busy wait of `spin` before each step. What is late is
/// never made up for by a hurry: the lines show the step that it is, and steps that passed are
/// counted. All LEDs are dark at the end.
class BarDriver {
  public:
    BarDriver(const SyncBar& bar, std::unique_ptr<BarLines> lines, std::chrono::nanoseconds spin,
              int realtime_priority);
    ~BarDriver();

    void stop();
    BarStatus status() const;
    /// Throws the Error that ended the counting, if one did.
    void rethrow_failure() const;
    /// Lines for the start-up report.
    std::vector<std::string> report() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage

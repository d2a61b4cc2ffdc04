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
    std::uint64_t shown = 0;    ///< steps shown
    std::uint64_t skipped = 0;  ///< steps that passed before the thread woke up
    Percentiles lateness_us;    ///< time of each change after its deadline
};

/// Counter that drives the LEDs of a sync bar on a thread of its own, by CLOCK_TAI. It uses
/// absolute deadlines, SCHED_FIFO and locked memory as far as permitted, and a busy wait of `spin`
/// before each step. After a late wake-up the LEDs show the current step, and the steps that passed
/// are counted as skipped. All LEDs are dark at the end.
class BarDriver {
  public:
    BarDriver(const SyncBar& bar, std::unique_ptr<BarLines> lines, std::chrono::nanoseconds spin,
              int realtime_priority);
    ~BarDriver();

    void stop();
    BarStatus status() const;
    /// Throws the Error that ended the thread, if there is one.
    void rethrow_failure() const;
    /// Lines for the start-up report.
    std::vector<std::string> report() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage

#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/base/percentiles.h"
#include "common/sync/sync_bar.h"

namespace vantage {

/// Output of a sync bar's LEDs: GPIO lines, or none for a dry run.
class BarLines {
  public:
    virtual ~BarLines() = default;
    /// Sets the LEDs in `changed` to their bits in `lit`; the others stay. Throws Error if the
    /// lines are gone.
    virtual void set(std::uint32_t lit, std::uint32_t changed) = 0;
    virtual std::string text() const = 0;
};

/// Opens lines of a chip by name as outputs, LED 0 (the fastest) first, all dark. Throws Error that
/// names the holder if a line is taken.
std::unique_ptr<BarLines> open_bar_lines(const std::string& chip,
                                         const std::vector<std::string>& names, bool active_low);

/// Returns an output without lines, for timing only.
std::unique_ptr<BarLines> pretend_bar_lines();

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

#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/base/percentiles.h"
#include "common/config/rig_config.h"

namespace vantage {

struct PulseStatus {
    std::uint64_t sent = 0;
    std::uint64_t skipped = 0;      ///< would have been later than the limit
    std::uint64_t clock_steps = 0;  ///< CLOCK_TAI was set
    std::uint64_t last_index = 0;   ///< of the last pulse sent
    Percentiles lateness_us;        ///< of the leading edges behind their time
    Percentiles width_error_us;     ///< of the pulses' widths; they set the exposure
};

/// Sends the pulses of the stage's clock on a thread of its own: absolute deadlines on CLOCK_TAI,
/// SCHED_FIFO and locked memory as far as permitted, a busy wait before the edges if configured.
/// The sensor's exposure sets the width. Nothing is sent before start().
class PulseSender {
  public:
    /// Takes the line. Throws Error if it, or the timing at `rate_hz`, cannot be had.
    /// `on_sent` is told of every pulse that was sent, on the thread that sends them.
    PulseSender(const RigConfig::Trigger& trigger, double rate_hz,
                std::function<void(std::uint64_t)> on_sent = {});
    ~PulseSender();

    /// Sends from pulse `first` on, or from the next one if that has passed.
    void start(std::uint64_t first);
    bool started() const;
    void stop();

    PulseStatus status() const;
    /// Throws the Error that ended the sending, if one did.
    void rethrow_failure() const;
    /// Lines for the start-up report.
    std::vector<std::string> report() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage

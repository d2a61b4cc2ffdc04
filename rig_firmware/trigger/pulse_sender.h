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
    std::uint64_t skipped = 0;      ///< pulses that would have exceeded the lateness limit
    std::uint64_t clock_steps = 0;  ///< times that CLOCK_TAI was set
    std::uint64_t last_index = 0;   ///< index of the last pulse sent
    Percentiles lateness_us;        ///< time of each leading edge after its deadline
    Percentiles width_error_us;     ///< error of the pulse width, which sets the exposure
};

/// Sends the stage's trigger pulses on a thread of its own. It uses absolute deadlines on
/// CLOCK_TAI, SCHED_FIFO and locked memory as far as permitted, and a busy wait before the edges if
/// configured. The sensor's exposure sets the pulse width. Nothing is sent before start().
class PulseSender {
  public:
    /// Opens the line. Throws Error if the line is not available or the timing is not possible at
    /// `rate_hz`. `on_sent` is called for every pulse that was sent, on the sending thread.
    PulseSender(const RigConfig::Trigger& trigger, double rate_hz,
                std::function<void(std::uint64_t)> on_sent = {});
    ~PulseSender();

    /// Sends pulses from `first` on, or from the next one if `first` has passed.
    void start(std::uint64_t first);
    bool started() const;
    void stop();

    PulseStatus status() const;
    /// Throws the Error that ended the sending, if there is one.
    void rethrow_failure() const;
    /// Lines for the start-up report.
    std::vector<std::string> report() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage

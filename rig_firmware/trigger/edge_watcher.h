#pragma once

#include <chrono>
#include <cstdint>
#include <gpiod.hpp>
#include <optional>

#include "common/base/time/time.h"
#include "common/config/rig_config.h"
#include "rig_firmware/trigger/gpio_line.h"

namespace vantage {

/// The leading edges of pulses that come over a wire, stamped by the kernel.
class EdgeWatcher {
  public:
    /// Takes the line of [trigger] as an input. Throws Error if it cannot be had.
    explicit EdgeWatcher(const RigConfig::Trigger& trigger);

    struct Edge {
        MonotonicTime time{};
        bool leading = true;     ///< of a pulse; else its end
        std::uint64_t lost = 0;  ///< edges that the kernel had no room for before this one
    };
    /// The next edge; empty when the time is up.
    std::optional<Edge> next(std::chrono::nanoseconds timeout);

    const GpioLine& line() const { return line_; }

  private:
    GpioLine line_;
    gpiod::line_request request_;
    gpiod::edge_event_buffer buffer_{1};
    std::optional<std::uint64_t> last_number_;
};

}  // namespace vantage

#pragma once

#include <chrono>
#include <cstdint>
#include <gpiod.hpp>
#include <optional>

#include "common/base/time/time.h"
#include "common/config/rig_config.h"
#include "rig_firmware/trigger/gpio_line.h"

namespace vantage {

/// Receives the edges of wired trigger pulses with the kernel's time stamps.
class EdgeWatcher {
  public:
    /// Opens the line of [trigger] as an input. Throws Error if it is not available.
    explicit EdgeWatcher(const RigConfig::Trigger& trigger);

    struct Edge {
        MonotonicTime time{};
        bool leading = true;     ///< true at the start of a pulse, false at its end
        std::uint64_t lost = 0;  ///< edges before this one that the kernel's buffer lost
    };
    /// Waits for the next edge; returns nothing after `timeout`.
    std::optional<Edge> next(std::chrono::nanoseconds timeout);

    const GpioLine& line() const { return line_; }

  private:
    GpioLine line_;
    gpiod::line_request request_;
    gpiod::edge_event_buffer buffer_{1};
    std::optional<std::uint64_t> last_number_;
};

}  // namespace vantage

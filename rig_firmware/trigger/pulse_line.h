#pragma once

#include <memory>
#include <string>

#include "common/config/rig_config.h"

namespace vantage {

/// Where pulses go: a GPIO line, or nowhere.
class PulseLine {
  public:
    virtual ~PulseLine() = default;
    /// True: the level of a pulse. Throws Error when the line is gone.
    virtual void set(bool pulse) = 0;
    virtual std::string text() const = 0;
};

/// The line of [trigger] as an output at rest, or a pretended one. Throws Error that says who holds
/// it if it is taken.
std::unique_ptr<PulseLine> open_pulse_line(const RigConfig::Trigger& trigger);

}  // namespace vantage

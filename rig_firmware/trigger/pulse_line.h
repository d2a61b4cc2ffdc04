#pragma once

#include <memory>
#include <string>

#include "common/config/rig_config.h"

namespace vantage {

/// Output of trigger pulses: a GPIO line, or none for a dry run.
class PulseLine {
  public:
    virtual ~PulseLine() = default;
    /// Sets the level; true is the level of a pulse. Throws Error if the line is gone.
    virtual void set(bool pulse) = 0;
    virtual std::string text() const = 0;
};

/// Opens the line of [trigger] as an idle output, or returns a dry-run output. Throws Error that
/// names the holder if the line is taken.
std::unique_ptr<PulseLine> open_pulse_line(const RigConfig::Trigger& trigger);

}  // namespace vantage

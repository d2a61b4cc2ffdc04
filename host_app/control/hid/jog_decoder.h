#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/base/time/time.h"
#include "host_app/control/hid/jog_event.h"
#include "host_app/control/hid/jog_port.h"

namespace vantage {

/// From one device's reports to events. Keeps what it needs of the reports before (counters that
/// wrap, buttons held), so there is one for every device that is plugged in.
class JogDecoder {
  public:
    virtual ~JogDecoder() = default;

    /// All controls that events may name.
    virtual std::vector<JogControl> controls() const = 0;

    /// Makes a device talk that was just opened. Throws Error if it refuses.
    virtual void start(JogPort&, MonotonicTime) {}
    /// Does what the device wants done again and again, or what its last report asks for; to be
    /// called after every report and ten times a second.
    virtual void keep_alive(JogPort&, MonotonicTime) {}

    /// Appends what a report says. Any bytes may come; false if they are no report of this device,
    /// and then nothing is appended.
    virtual bool decode(std::span<const std::uint8_t> report, std::vector<JogEvent>& events) = 0;
};

}  // namespace vantage

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/base/time/time.h"
#include "host_app/control/hid/jog_event.h"
#include "host_app/control/hid/jog_port.h"

namespace vantage {

/// Interface that decodes one device's reports into events. It keeps state between reports
/// (counters that wrap, held buttons), so that each device has a decoder of its own. Not
/// thread-safe.
class JogDecoder {
  public:
    virtual ~JogDecoder() = default;

    /// All controls that events may name.
    virtual std::vector<JogControl> controls() const = 0;

    /// Initialises a device that was just opened. Throws Error if it refuses.
    virtual void start(JogPort&, MonotonicTime) {}
    /// Sends what the device expects periodically or after its last report. Call it after every
    /// report and ten times per second.
    virtual void keep_alive(JogPort&, MonotonicTime) {}

    /// Appends the events of a report. Returns false, and appends nothing, if the bytes are not a
    /// report of this device. Accepts any bytes.
    virtual bool decode(std::span<const std::uint8_t> report, std::vector<JogEvent>& events) = 0;
};

}  // namespace vantage

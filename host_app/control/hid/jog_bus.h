#pragma once

#include <memory>
#include <vector>

#include "host_app/control/hid/jog_family.h"

namespace vantage {

/// Where controllers are plugged in.
class JogBus {
  public:
    virtual ~JogBus() = default;

    /// All nodes that are there now, of whatever device. A node with several collections comes once
    /// for each.
    virtual std::vector<JogPlace> list() = 0;
    /// Throws Error; where this user may not, with the udev rule that lets him.
    virtual std::unique_ptr<JogPort> open(const JogPlace& place) = 0;
};

/// This computer's: hidraw through hidapi, and evdev. To be used from one thread; the ports it
/// opens may each be used from another.
std::unique_ptr<JogBus> make_system_jog_bus();

}  // namespace vantage

#pragma once

#include <memory>
#include <vector>

#include "host_app/control/hid/jog_family.h"

namespace vantage {

/// Interface of the system's bus on which controllers are plugged in.
class JogBus {
  public:
    virtual ~JogBus() = default;

    /// Lists all nodes that exist now, of any device. A node with several collections is listed
    /// once for each.
    virtual std::vector<JogPlace> list() = 0;
    /// Opens a node. Throws Error; if this user may not open it, the message names the udev rule
    /// that permits it.
    virtual std::unique_ptr<JogPort> open(const JogPlace& place) = 0;
};

/// Creates the bus of this computer: hidraw through hidapi, and evdev. Use it from one thread; each
/// port that it opens may be used on another.
std::unique_ptr<JogBus> make_system_jog_bus();

}  // namespace vantage

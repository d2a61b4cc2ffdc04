#pragma once

#include <chrono>
#include <cstdint>

#include "host_app/control/hid/jog_port.h"

namespace vantage {

/// Response that a DaVinci Resolve Speed Editor expects to its challenge. S. Munaut found and
/// published the procedure and its constants (blackmagic-misc, bmd.py, 2021).
std::uint64_t speed_editor_response(std::uint64_t challenge);

/// Unlocks a Speed Editor over feature report 6; the device sends nothing before. Returns how long
/// it stays unlocked. Throws Error if the device does not follow the procedure.
std::chrono::seconds open_speed_editor(JogPort& port);

}  // namespace vantage

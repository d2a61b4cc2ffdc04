#pragma once

#include <chrono>
#include <cstdint>

#include "host_app/control/hid/jog_port.h"

namespace vantage {

/// What a DaVinci Resolve Speed Editor expects in answer to its challenge. The procedure and its
/// constants are those that S. Munaut found and published (blackmagic-misc, bmd.py, 2021).
std::uint64_t speed_editor_response(std::uint64_t challenge);

/// Makes a Speed Editor talk, over feature report 6: it is silent until it has been answered.
/// Returns how long it will talk. Throws Error if it does not follow the procedure.
std::chrono::seconds open_speed_editor(JogPort& port);

}  // namespace vantage

#pragma once

#include "host_app/desk/desk_switches.h"
#include "host_app/desk/panels/desk_parts.h"

namespace vantage {

/// Lays the whole desk out in the current ImGui frame.
DrawnDesk draw_desk(const DeskState& state, const DeskSwitches& switches, const UiFonts& fonts);

}  // namespace vantage

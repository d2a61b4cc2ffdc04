#pragma once

#include "host_app/desk/desk_parts.h"

namespace vantage {

/// What of the desk the operator has switched on.
struct DeskSwitches {
    bool panels = true;  ///< else the picture alone
    bool help = false;
};

/// Where the desk was drawn.
struct DrawnDesk {
    DeskRect picture;  ///< of the programme, with nothing over it unless there is an overlay
    bool has_overlay = false;
    DeskSpots spots;
};

/// Lays the whole desk out in the current ImGui frame.
DrawnDesk draw_desk(const DeskState& state, const DeskSwitches& switches, const UiFonts& fonts);

}  // namespace vantage

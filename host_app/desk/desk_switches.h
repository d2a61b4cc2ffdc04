#pragma once

#include "host_app/desk/outside_eye.h"

namespace vantage {

/// What of the desk the operator has switched on.
struct DeskSwitches {
    bool panels = true;       ///< else the picture alone
    int help = 0;             ///< the page that is shown; 0: none
    bool rigs = true;         ///< pictures and state of each, in a row below
    bool rigs_apart = false;  ///< they have a window of their own instead
    bool figures = false;     ///< the side says what was measured since the start
    bool outside = false;     ///< the stage is seen from outside, not from above
    OutsideEye eye = {};      ///< from there
    bool operator==(const DeskSwitches&) const = default;
};

}  // namespace vantage

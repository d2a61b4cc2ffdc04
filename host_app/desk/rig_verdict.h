#pragma once

#include "host_app/desk/desk_state.h"
#include "host_app/desk/windows/pen.h"

namespace vantage {

/// How a rig's state is told.
struct RigLook {
    const char* words;
    Mark mark;
};
RigLook look_of(RigState state);

}  // namespace vantage

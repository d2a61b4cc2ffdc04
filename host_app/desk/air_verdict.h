#pragma once

#include <string>

#include "host_app/desk/desk_state.h"
#include "host_app/desk/windows/pen.h"

namespace vantage {

/// Whether the programme is fit to go on air, for the status bar.
struct AirVerdict {
    enum class Level {
        ready,
        caution,    ///< a fault is visible in the picture, or may become visible soon
        not_ready,  ///< there is no current picture, or the rigs do not cover it
    };
    Level level = Level::ready;
    std::string why;  ///< the most serious reason in a few words; empty: none
};

AirVerdict air_verdict(const DeskState& state);

/// The words and the mark that show a rig's state.
struct RigStateLabel {
    const char* words;
    Mark mark;
};
RigStateLabel label_of(RigState state);

}  // namespace vantage

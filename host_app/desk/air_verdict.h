#pragma once

#include <string>

#include "host_app/desk/desk_state.h"

namespace vantage {

/// Whether the programme may go on air, for one look.
struct AirVerdict {
    enum class Level {
        ready,
        with_care,  ///< something is missing that can be seen in the picture, or soon may be
        not_ready,
    };
    Level level = Level::ready;
    std::string why;  ///< the gravest reason, a few words; empty: none
};

AirVerdict air_verdict(const DeskState& state);

}  // namespace vantage

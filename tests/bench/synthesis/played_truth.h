#pragma once

#include <string>

#include "common/gl/shader_library.h"

namespace vantage {

/// The demo as it is: rigs that are processes of their own, sockets, the governed programme.
struct PlayedTruth {
    double rate_hz = 25, seconds = 20;
    double settling_s = 5;  ///< at the start, not measured
    std::string quality = "auto";
    std::string strip;  ///< a picture file for some pictures above their truth; may be empty
};

/// Markdown. Makes contexts of its own. Throws Error if the rigs do not come.
std::string played_table(const PlayedTruth& wanted);

}  // namespace vantage

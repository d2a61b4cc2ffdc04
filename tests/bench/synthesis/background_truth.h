#pragma once

#include <string>
#include <vector>

#include "common/gl/shader_library.h"
#include "tests/bench/synthesis/matching_rig.h"

namespace vantage {

/// Four rigs that learn the background of the moving virtual stage.
struct BackgroundTruth {
    std::vector<std::uint64_t> scenes{0};
    MatchingRig::Settings rigs{.disparities = 32, .preset = MatchPreset::balanced};
    double apart_deg = 20, rate_hz = 5, seconds = 3;
    double start_s = 2;    ///< in the stage's loop
    std::string pictures;  ///< a folder for pictures of the error; may be empty
};

/// A Markdown table of how true the depth of the background is, by region. Needs a current context.
std::string background_table(const ShaderLibrary& library, const BackgroundTruth& wanted);

}  // namespace vantage

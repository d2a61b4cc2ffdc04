#pragma once

#include <string>
#include <vector>

#include "common/gl/shader_library.h"
#include "tests/bench/synthesis/matching_rig.h"
#include "tests/bench/synthesis/truth_regions.h"

namespace vantage {

/// Films of the moving virtual stage, an instant after the other, each waited for.
struct SteppedTruth {
    std::vector<std::string> synthesisers{"fused"};
    std::vector<std::uint64_t> scenes{0};
    MatchingRig::Settings rigs{.disparities = 32, .preset = MatchPreset::balanced};
    double apart_deg = 20, rate_hz = 5, settling_s = 3, measured_s = 1;
    double start_s = 2;  ///< in the stage's loop
    /// Where the cameras stand, in distances between two rigs from the middle of the four: between
    /// the middle rigs, between the last two, and beside the last. The rigs stand at -1.5 to 1.5.
    std::vector<double> cameras{0, 1, 1.6};
    int prepare_level = 0, render_level = 0;
    bool with_exact_depth = false;
    std::vector<TruthRegion> exact_in;  ///< where rigs have the stage's depth, not their matchers'
    bool knows_background = false;      ///< begins with what a loop of the stage tells of it
    bool with_regions = false;          ///< shares of pixels and of squared error, by TruthRegion
    bool with_times = true;             ///< of the processor
    /// A flight file: one camera of `flown_size` flies its move, and no camera stands still.
    std::string flight;
    cv::Size flown_size{480, 270};
    std::string
        pictures;  ///< a folder for the last picture of each view beside its truth; may be empty
};

/// A Markdown table, a row a synthesiser and set. Needs a current context.
std::string stepped_table(const ShaderLibrary& library, const SteppedTruth& wanted);

}  // namespace vantage

#pragma once

#include "rig_firmware/stereo/matcher.h"

namespace vantage::thesis {

/// What the thesis leaves to be chosen.
struct Settings {
    int snf_iterations;           ///< 1..16, of the left picture, for the discontinuity map
    int discontinuity_threshold;  ///< grey levels between neighbours, after filtering
    int aggregation_passes;
};

/// Presets differ in the number of passes only: 2 and 8 are those that the thesis' figures show,
/// and from 40 on more passes change little.
constexpr Settings settings_for(MatchPreset preset) {
    switch (preset) {
        case MatchPreset::fast:
            return {.snf_iterations = 2, .discontinuity_threshold = 24, .aggregation_passes = 2};
        case MatchPreset::balanced:
            break;
        case MatchPreset::quality:
            return {.snf_iterations = 4, .discontinuity_threshold = 24, .aggregation_passes = 40};
    }
    return {.snf_iterations = 4, .discontinuity_threshold = 24, .aggregation_passes = 8};
}

}  // namespace vantage::thesis

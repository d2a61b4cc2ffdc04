#pragma once

#include <vector>

#include "common/colour/colour_correction.h"

namespace vantage {

/// One surface as two cameras saw it; sRGB-coded, 0 to 1.
struct ColourPair {
    int a = 0, b = 0;
    Eigen::Vector3d a_coded, b_coded;
};

/// A surface whose colour is known.
struct ColourPatch {
    Eigen::Vector3d seen_coded, true_coded;
};

struct ColourMatch {
    struct Camera {
        ColourCorrection correction;
        double delta_e_before = 0, delta_e_after = 0;  ///< mean CIEDE2000 over its samples
        int samples = 0;
    };
    std::vector<Camera> cameras;
    double delta_e_before = 0, delta_e_after = 0;  ///< mean over all samples
};

/// Corrections that make the cameras' colours those of camera `reference`, all of them at once:
/// least squares of differences in CIELAB, with a loss that highlights cannot pull. Cameras that no
/// chain of pairs ties to the reference keep their colours. Throws Error for fewer than 24 pairs of
/// a camera that has some.
ColourMatch match_colours(int cameras, const std::vector<ColourPair>& pairs, int reference);

/// The correction that brings a chart's patches to their true colours. Patches that are burnt out
/// or black are left out; throws Error if fewer than 12 are left.
ColourMatch::Camera match_chart(const std::vector<ColourPatch>& patches);

}  // namespace vantage

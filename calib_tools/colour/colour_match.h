#pragma once

#include <optional>
#include <vector>

#include "common/colour/colour_correction.h"
#include "common/image/image.h"

namespace vantage {

/// Colours of one surface in two cameras, gamma-coded sRGB, 0 to 1.
struct ColourPair {
    int a = 0, b = 0;
    Eigen::Vector3d a_coded, b_coded;
};

/// Surface with a known colour.
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

/// Solves for colour corrections that match all cameras to camera `reference` at once: least
/// squares of differences in CIELAB, with a loss that is robust against highlights. Cameras that no
/// chain of pairs connects to the reference keep their colours. Throws Error for a camera with more
/// than 0 but fewer than 24 pairs.
ColourMatch match_colours(int cameras, const std::vector<ColourPair>& pairs, int reference);

/// Solves for the correction that gives a chart's patches their true colours. Burnt-out and black
/// patches are left out. Throws Error if fewer than 12 are left.
ColourMatch::Camera match_chart(const std::vector<ColourPatch>& patches);

/// Published sRGB colours (D65) of the 24 patches of the classic ColorChecker, row by row from dark
/// skin to black.
std::vector<Eigen::Vector3d> chart_colours();

/// Finds the chart in an image (OpenCV's mcc) and measures its patches. Empty if there is none.
std::optional<std::vector<ColourPatch>> find_chart(const ColourImage& picture);

}  // namespace vantage

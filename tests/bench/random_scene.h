#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <opencv2/core.hpp>

#include "common/image/image.h"

namespace vantage {

/// A stereo pair with everything known about it.
struct StereoScene {
    std::string name;
    ColourImage left, right;
    cv::Mat1f disparity_px;   ///< of the left picture; +infinity = unknown
    cv::Mat1b non_occluded;   ///< 255 = seen by both cameras, to be judged
    int disparities = 64;     ///< range to search
    bool for_tuning = false;  ///< settings were chosen with it in sight: not in the verdict
};

/// How the pictures of a random scene leave the sensors.
struct RandomSceneLook {
    int width_px = 450, height_px = 375, disparities = 64;
    double noise_sigma = 1.5;       ///< Gaussian, 8-bit levels, both sensors
    double right_gain = 1.0;        ///< exposure of the right sensor against the left
    double right_offset = 0.0;      ///< 8-bit levels
    double right_shift_y_px = 0.0;  ///< vertical misalignment
};

/// Slanted and curved, overlapping surfaces: photographs, noise textures of all scales, repeated
/// patterns and plain paint, a few thin poles; exact disparity and exact visibility. The same seed
/// gives the same scene. `photographs` may be empty; then all textures are computed.
StereoScene make_random_scene(std::uint64_t seed, const RandomSceneLook& look,
                              const std::vector<ColourImage>& photographs);

}  // namespace vantage

#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <opencv2/core.hpp>

#include "common/image/image.h"

namespace vantage {

/// What a scene has to do with how the settings were chosen.
enum class SceneUse {
    tuning,    ///< settings were chosen by it
    in_sight,  ///< its results were known while they were chosen, or it shows what a tuning scene
               ///< shows
    held_out,  ///< a photograph whose results chose nothing
    held_out_generated,  ///< likewise, of the generator that made scenes for tuning
};

/// A stereo pair with everything known about it.
struct StereoScene {
    std::string name;
    ColourImage left, right;
    cv::Mat1f disparity_px;  ///< of the left picture; +infinity = unknown
    cv::Mat1b non_occluded;  ///< 255 = seen by both cameras, to be judged
    int disparities = 64;    ///< range to search
    SceneUse use = SceneUse::held_out;
};

/// How the pictures of a random scene leave the sensors.
struct RandomSceneLook {
    int width_px = 450, height_px = 375, disparities = 64;
    double noise_sigma = 1.5;       ///< Gaussian, 8-bit levels, both sensors
    double right_gain = 1.0;        ///< exposure of the right sensor against the left
    double right_offset = 0.0;      ///< 8-bit levels
    double right_shift_y_px = 0.0;  ///< vertical misalignment
};

/// Settings are chosen on scenes of smaller seeds, and judged on these and the ones that follow.
inline constexpr std::uint64_t first_held_out_seed = 20001;

/// Slanted and curved, overlapping surfaces: photographs, noise textures of all scales, repeated
/// patterns and plain paint, a few thin poles; exact disparity and exact visibility. The same seed
/// gives the same scene. `photographs` may be empty; then all textures are computed.
StereoScene make_random_scene(std::uint64_t seed, const RandomSceneLook& look,
                              const std::vector<ColourImage>& photographs);

}  // namespace vantage

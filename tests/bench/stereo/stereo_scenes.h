#pragma once

#include <filesystem>
#include <vector>

#include "tests/bench/stereo/random_scene.h"

namespace vantage {

/// Every stereo pair with truth below the data folder: middlebury2001, 2003, 2006 (folders of half
/// size, or NAME_third), eval3.
std::vector<StereoScene> load_stereo_scenes(const std::filesystem::path& data);

/// Photographs for the textures of random scenes (none of them from the stereo pairs).
std::vector<ColourImage> load_texture_photographs(const std::filesystem::path& data);

/// 255 where the truth is known of what only the left camera sees.
cv::Mat1b seen_by_left_only(const StereoScene& scene);

/// The share of the pixels of `where` (255, their truth known) that are unknown or further than
/// `threshold_px` from the truth.
double bad_share(const cv::Mat1f& disparity_px, const StereoScene& scene, const cv::Mat1b& where,
                 float threshold_px);

}  // namespace vantage

#pragma once

#include <opencv2/core.hpp>

namespace vantage {

// Pictures in memory. All are cv::Mat of one fixed element type, so a wrong one does not compile.

/// Colour: R, G, B, A order (not OpenCV's BGR), 8 bits each, A = 255. Uploads to GL_RGBA8 as it is.
using ColourImage = cv::Mat4b;

/// Luma or a raw sensor plane, 8 bits.
using GreyImage = cv::Mat1b;

/// Disparity of the left camera in steps of 1/32 px, positive, x_right = x_left - d; 0 = unknown.
/// The form on the wire and on the GPU.
using DisparityImage = cv::Mat1w;

inline constexpr int disparity_steps_per_px = 32;
inline constexpr float max_disparity_px = 65535.0f / disparity_steps_per_px;

/// Depth along the camera's z axis in metres; 0 = unknown.
using DepthImage = cv::Mat1f;

}  // namespace vantage

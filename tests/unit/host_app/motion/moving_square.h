#pragma once

#include <opencv2/imgproc.hpp>

#include "common/wire/frame_message.h"

namespace vantage {

constexpr int width = 160, height = 120, square = 40;
constexpr std::uint16_t far_steps = 10 * 32, near_steps = 20 * 32;

/// Noise that is smooth enough to be followed.
inline cv::Mat texture(int columns, int rows, std::uint64_t seed) {
    cv::Mat noise(rows, columns, CV_8UC3);
    cv::RNG random(seed);
    random.fill(noise, cv::RNG::UNIFORM, 0, 256);
    cv::GaussianBlur(noise, noise, {}, 2);
    cv::normalize(noise, noise, 20, 235, cv::NORM_MINMAX);
    cv::Mat colour;
    cv::cvtColor(noise, colour, cv::COLOR_BGR2RGBA);
    return colour;
}

/// A textured square before a textured wall, at x.
inline RigFrame frame_at(int x, std::int64_t exposure_ns) {
    RigFrame frame;
    frame.rig = "north";
    frame.trigger_index = 7;
    frame.exposure = tai_from_ns(exposure_ns);
    frame.colour = ColourImage(texture(width, height, 1));
    frame.disparity = DisparityImage(height, width, far_steps);
    const cv::Rect place(x, (height - square) / 2, square, square);
    texture(square, square, 2).copyTo(frame.colour(place));
    frame.disparity(place) = near_steps;
    return frame;
}

}  // namespace vantage

#pragma once

#include <cstdint>

#include "common/wire/frame_message.h"

namespace vantage {

/// A small valid frame with pictures of noise over a slope: synchronized, of pulse `trigger_index`.
RigFrame make_frame(std::uint64_t trigger_index, int width_px = 61, int height_px = 47);

/// The same numbers, element by element.
bool same_pixels(const cv::Mat& a, const cv::Mat& b);

}  // namespace vantage

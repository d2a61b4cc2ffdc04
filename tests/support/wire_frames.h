#pragma once

#include <cstdint>

#include "common/wire/frame_message.h"

namespace vantage {

/// A small valid frame of noise over a slope: synchronized, of pulse `trigger_index`.
RigFrame make_frame(std::uint64_t trigger_index, int width_px = 61, int height_px = 47);

/// Whether two images have equal values.
bool same_pixels(const cv::Mat& a, const cv::Mat& b);

}  // namespace vantage

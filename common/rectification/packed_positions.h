#pragma once

#include <optional>

#include <opencv2/core.hpp>

namespace vantage {

/// A rectification map in half the memory, for RectifyPass: a word for each pixel of the target,
/// with its distance to the position in the raw picture in 1/256 px, plus 32768, x in the lower and
/// y in the upper half. 0: nothing of the raw picture is there. Empty where a distance is 128 px or
/// more.
std::optional<cv::Mat1i> packed_positions(const cv::Mat2f& positions, cv::Size raw_size);

}  // namespace vantage

#pragma once

#include <string>

#include <opencv2/core/types.hpp>

namespace vantage {

/// "1280x720", each side 16..4096. Throws Error otherwise.
cv::Size parse_size(const std::string& text);

/// "25", "29.97", "30000/1001", within 0.1..240; 29.97 and its like are n * 1000 / 1001. Throws
/// Error otherwise.
double parse_rate(const std::string& text);

}  // namespace vantage

#pragma once

#include <filesystem>

#include <opencv2/core.hpp>

namespace vantage {

/// The picture that a USB camera of the tests shows: the file in grey at that size, as YUYV (two
/// bytes a pixel). Throws Error if it cannot be read.
cv::Mat2b yuyv_picture(const std::filesystem::path& file, const cv::Size& size);

}  // namespace vantage

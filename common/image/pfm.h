#pragma once

#include <filesystem>

#include <opencv2/core.hpp>

namespace vantage {

/// One-channel PFM ("Pf"), rows from the bottom up in the file, from the top down in memory, either
/// byte order. The magnitude of the scale is ignored, as Middlebury's files want it. Throws Error
/// for anything else.
cv::Mat1f read_pfm(const std::filesystem::path& path);

/// Writes little-endian, whole or not at all.
void write_pfm(const std::filesystem::path& path, const cv::Mat1f& image);

}  // namespace vantage

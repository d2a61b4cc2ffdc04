#pragma once

#include <filesystem>

#include "common/image/image.h"
#include "common/image/picture_size.h"

namespace vantage {

/// Whether it begins as one of the formats that are read.
bool is_picture_file(const std::filesystem::path& path);

/// Reads a PNG, JPEG, PGM or PPM as RGBA, 8 bits a channel. Throws Error naming the file and what
/// is wrong with it: missing, not a picture, damaged, or wider or higher than max_image_side_px.
ColourImage read_colour_image(const std::filesystem::path& path);

/// Reads a one-channel picture of 8 or 16 bits without scaling its values (for disparity and depth
/// codes); a colour file with equal channels is taken as grey.
cv::Mat1w read_code_image(const std::filesystem::path& path);

/// Throws Error, before any work is done, if no picture format goes by the path's extension.
void require_picture_extension(const std::filesystem::path& path);

/// Writes PNG or JPEG by the path's extension, whole or not at all.
void write_colour_image(const std::filesystem::path& path, const ColourImage& image);
void write_grey_image(const std::filesystem::path& path, const cv::Mat& one_channel_8_or_16_bit);

/// RGBA to luma with the weights of ITU-R BT.601, rounded, as the shaders do it.
GreyImage to_grey(const ColourImage& image);

}  // namespace vantage

#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <utility>

#include "common/image/code_range.h"
#include "common/image/image.h"
#include "common/image/picture_size.h"

namespace vantage {

/// Whether it begins as one of the formats that are read.
bool is_picture_file(const std::filesystem::path& path);

/// Reads a PNG, JPEG, PBM, PGM or PPM as RGBA, 8 bits a channel, as it is stored: an orientation in
/// its metadata is warned of and not applied. Codes of 16 bits are scaled by the range that they
/// use (see CodeRange). Throws Error naming the file and what is wrong with it: missing, not a
/// picture, damaged, or wider or higher than max_image_side_px.
ColourImage read_colour_image(const std::filesystem::path& path);
/// Reads one of several pictures that belong together. `range` is that of the others, and grows
/// with a warning where this one exceeds it.
ColourImage read_colour_image(const std::filesystem::path& path, CodeRange& range);
/// Reads the two sides of a rig, whose codes have one range.
std::pair<ColourImage, ColourImage> read_colour_pair(const std::filesystem::path& left,
                                                     const std::filesystem::path& right);

/// The range of the 16-bit pictures among so many of these files, evenly chosen; says it where it
/// is not that of the container. Files that cannot be read are passed over.
CodeRange common_code_range(std::span<const std::filesystem::path> files, std::size_t most_samples);

/// Reads a one-channel picture of 8 or 16 bits without scaling its values (for disparity and depth
/// codes); a colour file with equal channels is taken as grey.
cv::Mat1w read_code_image(const std::filesystem::path& path);

/// Throws Error, before any work is done, if no picture format goes by the path's extension.
void require_picture_extension(const std::filesystem::path& path);

/// Writes PNG or JPEG by the path's extension, whole or not at all.
void write_colour_image(const std::filesystem::path& path, const ColourImage& image);
/// Likewise; a PNG has the mask (0 or 255) as its alpha, a JPEG has none.
void write_with_alpha(const std::filesystem::path& path, const ColourImage& image,
                      const cv::Mat1b& alpha);
void write_grey_image(const std::filesystem::path& path, const cv::Mat& one_channel_8_or_16_bit);

/// RGBA to luma with the weights of ITU-R BT.601, rounded, as the shaders do it.
GreyImage to_grey(const ColourImage& image);

}  // namespace vantage

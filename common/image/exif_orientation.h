#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace vantage {

/// The orientation that EXIF data (a TIFF header and its first directory) states, 1 to 8; 1 where
/// it states none or is damaged.
int exif_orientation(std::span<const std::byte> tiff);

/// Describes how a viewer shows an image of this orientation: "turned by 90 degrees clockwise".
std::string orientation_in_words(int orientation);

}  // namespace vantage

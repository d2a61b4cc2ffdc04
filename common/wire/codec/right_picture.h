#pragma once

#include <cstddef>
#include <vector>

#include "common/wire/codec/colour_codec.h"

namespace vantage {

// A rig's rectified right image, which it sends occasionally, so that the host can match the
// rig's background.

/// The size at which a background of `colour` pixels is matched: that size, or a half or a third of
/// it where matching would take too much memory. A rig sends its right image at this size.
cv::Size background_match_size(cv::Size colour);

/// A JPEG of that size with full chroma, since backgrounds are matched to a fraction of a pixel.
std::vector<std::byte> pack_right_picture(JpegEncoder& jpeg, const ColourImage& right);

}  // namespace vantage

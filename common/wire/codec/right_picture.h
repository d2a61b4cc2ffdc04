#pragma once

#include <cstddef>
#include <vector>

#include "common/wire/codec/colour_codec.h"

namespace vantage {

// A rig's rectified right picture, which travels now and then: by what stands still in it a host
// matches the rig's set.

/// At which a set of `colour` pixels is matched, where larger ones would take too much: that size,
/// or a half, a third of it. A rig need not send more of its right picture.
cv::Size background_match_size(cv::Size colour);

/// A JPEG of that size, of whole chroma, for sets are matched to a part of a pixel.
std::vector<std::byte> pack_right_picture(JpegEncoder& jpeg, const ColourImage& right);

}  // namespace vantage

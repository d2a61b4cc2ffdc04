#pragma once

#include "common/image/image.h"

namespace vantage {

/// The same, no wider than a place of a bin needs.
ColourImage small_picture(const ColourImage& picture);

}  // namespace vantage

#pragma once

namespace vantage {

// The kinds of background_kinds.glsl.
inline constexpr int the_set = 0, lit_background = 64, untold = 112, new_background = 152, uncovered = 192,
                     before_background = 255;

}  // namespace vantage

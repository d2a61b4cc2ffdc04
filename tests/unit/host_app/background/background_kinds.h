#pragma once

namespace vantage {

// The kinds of set_kinds.glsl.
inline constexpr int the_set = 0, lit_set = 64, untold = 112, new_set = 152, uncovered = 192,
                     before_set = 255;

}  // namespace vantage

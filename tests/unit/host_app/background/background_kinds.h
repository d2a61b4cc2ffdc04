#pragma once

namespace vantage {

// The kinds of background_kinds.glsl.
inline constexpr int the_background = 0, lit_background = 64, undecided = 112, new_background = 152,
                     uncovered = 192, before_background = 255;

}  // namespace vantage

#pragma once

#include <string>

#include "host_app/desk/windows/pen.h"

namespace vantage {

/// A place of a bin: what it shows, if anything, and its name in the lower left corner.
void draw_bin_cell(const Pen& pen, const DeskRect& place, const Texture* picture,
                   const std::string& words, const ImVec4& colour);

}  // namespace vantage

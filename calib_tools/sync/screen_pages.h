#pragma once

#include <span>

#include "common/base/files/embedded_text.h"

namespace vantage {

/// screen_bar.html: a page that counts on a screen instead of a bar, with 8 spots and one step per
/// refresh.
std::span<const EmbeddedText> screen_pages();

}  // namespace vantage

#pragma once

#include <span>

#include "common/base/files/embedded_text.h"

namespace vantage {

/// screen_bar.html: a page that counts on a screen in place of a bar, 8 spots, a step a refresh.
std::span<const EmbeddedText> screen_pages();

}  // namespace vantage

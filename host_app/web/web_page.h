#pragma once

#include <span>

#include "common/base/files/embedded_text.h"

namespace vantage {

/// The page for tablets and phones: one HTML file without any other.
std::span<const EmbeddedText> embedded_web_page();

}  // namespace vantage

#pragma once

#include <span>

#include "common/base/files/embedded_text.h"

namespace vantage {

/// Built-in copies of the files in hw_config/jog.
std::span<const EmbeddedText> embedded_wheels();

}  // namespace vantage

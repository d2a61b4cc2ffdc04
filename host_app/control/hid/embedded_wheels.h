#pragma once

#include <span>

#include "common/base/files/embedded_text.h"

namespace vantage {

/// The files of hw_config/jog as they were built in.
std::span<const EmbeddedText> embedded_wheels();

}  // namespace vantage

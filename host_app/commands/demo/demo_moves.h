#pragma once

#include <span>
#include <string>
#include <string_view>

#include "common/base/files/embedded_text.h"

namespace vantage {

/// Of hw_config/moves: demo.toml, before the demo's stage; sweep.toml, around it; pair.toml, before
/// a single pair, 2 m from its camera, which sees 30 degrees.
std::span<const EmbeddedText> demo_moves();

/// One of them. Precondition: it is there.
std::string demo_move(std::string_view name);

}  // namespace vantage

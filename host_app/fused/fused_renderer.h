#pragma once

#include <memory>

#include "host_app/synthesis/synthesiser.h"

namespace vantage {

/// Makes the renderer of `fused`. It draws the background from an instant's BakedExtra at the
/// levels that say so, and otherwise from the rigs' surfaces.
std::unique_ptr<ViewRenderer> make_fused_renderer(const ShaderLibrary& library);

}  // namespace vantage

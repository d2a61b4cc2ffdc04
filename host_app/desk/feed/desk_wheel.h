#pragma once

#include <optional>

#include "host_app/control/hid/wheel_input.h"
#include "host_app/desk/desk_state.h"

namespace vantage {

/// What the desk shows of a wheel's map; nothing: it is closed.
std::optional<DeskWheel> desk_wheel(const std::optional<WheelMapView>& view);

}  // namespace vantage

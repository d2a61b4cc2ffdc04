#pragma once

#include <gpiod.hpp>
#include <vector>

#include "rig_firmware/trigger/gpio_line.h"

namespace vantage {

/// Takes the line for this program ("vantage"). Throws Error that says who holds it, or that this
/// user may not, with the mend.
gpiod::line_request request_line(const GpioLine& line, const gpiod::line_settings& settings);

/// The same of several lines of one chip, which can then be set together.
gpiod::line_request request_lines(const std::vector<GpioLine>& lines,
                                  const gpiod::line_settings& settings);

}  // namespace vantage

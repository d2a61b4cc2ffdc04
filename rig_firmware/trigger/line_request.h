#pragma once

#include <gpiod.hpp>
#include <vector>

#include "rig_firmware/trigger/gpio_line.h"

namespace vantage {

/// Requests a line under the name "vantage". Throws Error that names the holder, or the missing
/// permission with the mend.
gpiod::line_request request_line(const GpioLine& line, const gpiod::line_settings& settings);

/// Requests several lines of one chip, which can then be set together. Throws like request_line().
gpiod::line_request request_lines(const std::vector<GpioLine>& lines,
                                  const gpiod::line_settings& settings);

}  // namespace vantage

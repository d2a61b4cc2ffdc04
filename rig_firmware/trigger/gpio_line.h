#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/config/rig_config.h"

namespace vantage {

/// Paths of all GPIO chips (/dev/gpiochip*), sorted.
std::vector<std::filesystem::path> gpio_chips();

/// State of one line of a GPIO chip, as the kernel reports it.
struct GpioLine {
    std::filesystem::path chip;  ///< /dev/gpiochipN; N differs between kernels
    std::string label;           ///< label of the chip; the same for all kernels
    unsigned offset = 0;
    std::string name;  ///< may be empty
    std::string
        consumer;  ///< program that holds the line; empty if it is free or held by the kernel
    bool is_used = false;

    std::string text() const;  ///< "line 17 'GPIO17' of 'pinctrl-rp1'"
};

/// Finds the line by its chip's label and its name or offset. Throws Error that lists the existing
/// lines, or that names the chip that this user may not open and the mend.
GpioLine find_gpio_line(const RigConfig::Trigger& trigger);

}  // namespace vantage

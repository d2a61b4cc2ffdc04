#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/config/rig_config.h"

namespace vantage {

/// /dev/gpiochip*, sorted.
std::vector<std::filesystem::path> gpio_chips();

/// A line of a GPIO chip, as the kernel knows it now.
struct GpioLine {
    std::filesystem::path chip;  ///< /dev/gpiochipN; N differs between kernels
    std::string label;           ///< of the chip; does not
    unsigned offset = 0;
    std::string name;      ///< may be empty
    std::string consumer;  ///< who holds it; empty: free, or held by the kernel
    bool is_used = false;

    std::string text() const;  ///< "line 17 'GPIO17' of 'pinctrl-rp1'"
};

/// Finds the line by its chip's label and its name or offset. Throws Error that lists what there
/// is, and names who may not open a chip and the mend.
GpioLine find_gpio_line(const RigConfig::Trigger& trigger);

}  // namespace vantage

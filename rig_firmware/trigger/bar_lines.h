#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vantage {

/// Where the LEDs of a bar hang: GPIO lines, or nowhere.
class BarLines {
  public:
    virtual ~BarLines() = default;
    /// Lights the LEDs of the set bits, of those in `changed`; the others stay. Throws Error when
    /// the lines are gone.
    virtual void set(std::uint32_t lit, std::uint32_t changed) = 0;
    virtual std::string text() const = 0;
};

/// These lines of a chip, by name, LED 0 (the fastest) first, as outputs, dark. Throws Error that
/// says who holds one if it is taken.
std::unique_ptr<BarLines> open_bar_lines(const std::string& chip,
                                         const std::vector<std::string>& names, bool active_low);

/// No lines, only the timing.
std::unique_ptr<BarLines> pretend_bar_lines();

}  // namespace vantage

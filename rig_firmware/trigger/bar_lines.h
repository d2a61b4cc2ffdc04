#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vantage {

/// Output of a sync bar's LEDs: GPIO lines, or none for a dry run.
class BarLines {
  public:
    virtual ~BarLines() = default;
    /// Sets the LEDs in `changed` to their bits in `lit`; the others stay. Throws Error if the
    /// lines are gone.
    virtual void set(std::uint32_t lit, std::uint32_t changed) = 0;
    virtual std::string text() const = 0;
};

/// Opens lines of a chip by name as outputs, LED 0 (the fastest) first, all dark. Throws Error that
/// names the holder if a line is taken.
std::unique_ptr<BarLines> open_bar_lines(const std::string& chip,
                                         const std::vector<std::string>& names, bool active_low);

/// Returns an output without lines, for timing only.
std::unique_ptr<BarLines> pretend_bar_lines();

}  // namespace vantage

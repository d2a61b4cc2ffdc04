#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace vantage {

/// A Contour ShuttleXpress without hands: turns words into the reports that the wheel would send.
///   jog N       N detents, clockwise if positive, -100 to 100
///   shuttle N   the ring at N and there it stays, -7 to 7
///   bN          button N pressed and let go, 1 to 5
class SimulatedXpress {
  public:
    using Report = std::array<std::uint8_t, 5>;

    static constexpr std::uint16_t vendor = 0x0b33, product = 0x0020;
    static constexpr const char* name = "Contour Design ShuttleXpress";
    static constexpr const char* words = "jog 3, jog -3, shuttle 4, shuttle 0, b1 to b5";

    /// Throws Error naming the word that does not fit. The first report is how the wheel stands
    /// already, since whoever opens a wheel takes the first one as that.
    std::vector<Report> reports_of(const std::string& line);

  private:
    Report report(std::uint16_t buttons = 0) const;

    std::int8_t ring_ = 0;
    std::uint8_t counter_ = 0;
};

}  // namespace vantage

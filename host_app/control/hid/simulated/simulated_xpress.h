#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace vantage {

/// Simulated Contour ShuttleXpress: converts commands into the reports that the wheel would send.
///   jog N       N detents, clockwise if positive, -100 to 100
///   shuttle N   turn the ring to N and leave it there, -7 to 7
///   bN          press and release button N, 1 to 5
class SimulatedXpress {
  public:
    using Report = std::array<std::uint8_t, 5>;

    static constexpr std::uint16_t vendor = 0x0b33, product = 0x0020;
    static constexpr const char* name = "Contour Design ShuttleXpress";
    static constexpr const char* words = "jog 3, jog -3, shuttle 4, shuttle 0, b1 to b5";

    /// Throws Error with the word that is not valid. The first report is the initial position,
    /// since a reader of a wheel takes its first report as that.
    std::vector<Report> reports_of(const std::string& line);

  private:
    Report report(std::uint16_t buttons = 0) const;

    std::int8_t ring_ = 0;
    std::uint8_t counter_ = 0;
};

}  // namespace vantage

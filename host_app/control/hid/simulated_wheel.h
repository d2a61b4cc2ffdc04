#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "common/base/files/unique_fd.h"

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

/// Simulated HID device, made through /dev/uhid: construction plugs it in, destruction unplugs it.
/// The rest of the system cannot tell it from a real one.
class UhidWheel {
  public:
    struct Kind {
        std::uint16_t vendor = 0, product = 0;
        std::string name;
        std::vector<std::uint8_t> descriptor;
        /// Callbacks for feature reports: one to read a report, one to write it.
        std::function<std::vector<std::uint8_t>(std::uint8_t id)> get_feature;
        std::function<void(std::span<const std::uint8_t> report)> set_feature;
    };
    /// Descriptor of input reports with this number of bytes and without an id.
    static std::vector<std::uint8_t> input_of(std::uint8_t bytes);
    /// Descriptor with the report size of Contour's wheels.
    static std::vector<std::uint8_t> five_bytes() { return input_of(5); }

    /// Throws Error if /dev/uhid does not exist or this user may not open it.
    explicit UhidWheel(Kind kind);
    ~UhidWheel();
    UhidWheel(const UhidWheel&) = delete;
    UhidWheel& operator=(const UhidWheel&) = delete;

    void send(const std::vector<std::uint8_t>& report) const;

  private:
    void answer(const std::stop_token& stop) const;

    Kind kind_;
    UniqueFd fd_;
    std::jthread thread_;
};

}  // namespace vantage

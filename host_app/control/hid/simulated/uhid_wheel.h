#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "common/base/files/unique_fd.h"

namespace vantage {

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

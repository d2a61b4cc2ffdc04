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

/// A HID device that exists only in the kernel: made through /dev/uhid when constructed (plugged
/// in) and gone when destroyed (unplugged). To the rest of the system it is as real as any.
class UhidWheel {
  public:
    struct Kind {
        std::uint16_t vendor = 0, product = 0;
        std::string name;
        std::vector<std::uint8_t> descriptor;
        /// Answers feature reports: what is read of one; and what is written to one.
        std::function<std::vector<std::uint8_t>(std::uint8_t id)> get_feature;
        std::function<void(std::span<const std::uint8_t> report)> set_feature;
    };
    /// The descriptor of input reports of so many bytes without an id.
    static std::vector<std::uint8_t> input_of(std::uint8_t bytes);
    /// As Contour's wheels have.
    static std::vector<std::uint8_t> five_bytes() { return input_of(5); }

    /// Throws Error where there is no /dev/uhid or this user may not open it.
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

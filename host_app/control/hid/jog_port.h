#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <vector>

namespace vantage {

/// An open controller, report by report. Of a HID device a report that has an id starts with it; of
/// an evdev device a report is one or more whole `input_event`s. Every member throws Error when the
/// device is gone.
class JogPort {
  public:
    virtual ~JogPort() = default;

    /// Waits for one report; empty if none came in time.
    virtual std::vector<std::uint8_t> read(std::chrono::milliseconds timeout) = 0;
    /// Sends an output report. Its first byte is its id, 0 if the device has none.
    virtual void write(std::span<const std::uint8_t> report) = 0;
    virtual void send_feature(std::span<const std::uint8_t> report) = 0;
    /// The feature report of this id, which is its first byte; at most `size` bytes.
    virtual std::vector<std::uint8_t> get_feature(std::uint8_t id, std::size_t size) = 0;
};

}  // namespace vantage

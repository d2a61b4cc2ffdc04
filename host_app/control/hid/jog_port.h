#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <vector>

namespace vantage {

/// Interface of an open controller. HID reports that have an id start with it; an evdev report is
/// one or more whole `input_event`s. Every member throws Error when the device is gone. Use it from
/// one thread.
class JogPort {
  public:
    virtual ~JogPort() = default;

    /// Waits for one report; empty after `timeout`.
    virtual std::vector<std::uint8_t> read(std::chrono::milliseconds timeout) = 0;
    /// Sends an output report. The first byte is its id, or 0 if the device has no ids.
    virtual void write(std::span<const std::uint8_t> report) = 0;
    virtual void send_feature(std::span<const std::uint8_t> report) = 0;
    /// Reads the feature report with this id, which is its first byte; at most `size` bytes.
    virtual std::vector<std::uint8_t> get_feature(std::uint8_t id, std::size_t size) = 0;
};

}  // namespace vantage

#pragma once

#include <bit>
#include <cassert>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/base/time/time.h"

namespace vantage {

enum class JogKind {
    step,    ///< detents since the previous event; positive is clockwise
    axis,    ///< position of a spring-centred control, -1..1, 0 at rest
    button,  ///< 1 pressed, 0 released
};

/// Operator input on a device: the control, by the name its decoder gives it, and its value.
struct JogEvent {
    JogKind kind = JogKind::step;
    std::string control;
    double value = 0;

    bool operator==(const JogEvent&) const = default;
};

/// One control of a device.
struct JogControl {
    JogKind kind = JogKind::step;
    std::string name;
};

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

/// Interface that decodes one device's reports into events. It keeps state between reports
/// (counters that wrap, held buttons), so that each device has a decoder of its own. Not
/// thread-safe.
class JogDecoder {
  public:
    virtual ~JogDecoder() = default;

    /// All controls that events may name.
    virtual std::vector<JogControl> controls() const = 0;

    /// Initialises a device that was just opened. Throws Error if it refuses.
    virtual void start(JogPort&, MonotonicTime) {}
    /// Sends what the device expects periodically or after its last report. Call it after every
    /// report and ten times per second.
    virtual void keep_alive(JogPort&, MonotonicTime) {}

    /// Appends the events of a report. Returns false, and appends nothing, if the bytes are not a
    /// report of this device. Accepts any bytes.
    virtual bool decode(std::span<const std::uint8_t> report, std::vector<JogEvent>& events) = 0;
};

enum class JogTransport {
    hidraw,  ///< through hidapi
    evdev,   ///< if a kernel driver has taken the device, or usbhid ignores it
};

/// USB vendor and product ids, "0b33:0020".
struct JogId {
    std::uint16_t vendor = 0, product = 0;
    auto operator<=>(const JogId&) const = default;
};
std::string to_text(JogId id);
/// Parses VVVV:PPPP in hexadecimal. Throws Error.
JogId parse_jog_id(const std::string& text);

struct JogModel {
    JogId id;
    std::string name;
};

/// Device node that the system lists, open or not.
struct JogPlace {
    JogTransport transport = JogTransport::hidraw;
    std::string path;  ///< /dev/hidraw3
    JogId id;
    std::string name, serial;
    int interface_number = -1;                ///< of a USB device with several; -1 if unknown
    std::uint16_t usage_page = 0, usage = 0;  ///< of the HID collection; 0 if unknown

    bool same_node(const JogPlace& other) const { return path == other.path; }
};

/// Family of devices with the same protocol. A family is one file, families/NAME_family.cpp, that
/// defines `JogFamily NAME_family_entry()`.
struct JogFamily {
    std::string name;
    JogTransport transport = JogTransport::hidraw;
    std::vector<JogModel> models;
    /// Selects the node of a device that sends events; empty: the one of its first interface.
    std::function<bool(const JogPlace&)> speaks;
    std::function<std::unique_ptr<JogDecoder>(JogId)> make_decoder;
};

/// Readers of little-endian numbers in a report. Precondition of all: the report is long enough.
inline std::int8_t int8_at(std::span<const std::uint8_t> report, std::size_t at) {
    assert(at < report.size());
    return static_cast<std::int8_t>(report[at]);
}
inline std::uint16_t uint16_at(std::span<const std::uint8_t> report, std::size_t at) {
    assert(at + 1 < report.size());
    return static_cast<std::uint16_t>(report[at] | report[at + 1] << 8);
}
inline std::int16_t int16_at(std::span<const std::uint8_t> report, std::size_t at) {
    return static_cast<std::int16_t>(uint16_at(report, at));
}
/// Reads `bytes` bytes, at most eight.
inline std::uint64_t uint_at(std::span<const std::uint8_t> report, std::size_t at,
                             std::size_t bytes) {
    assert(bytes <= 8 && at + bytes <= report.size());
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i)
        value |= static_cast<std::uint64_t>(report[at + i]) << (8 * i);
    return value;
}

/// Converts masks of held buttons into events for the buttons that changed.
class HeldButtons {
  public:
    /// `name_of` returns the name of a bit's button; an empty name means no button.
    void update(std::uint64_t mask, const std::function<std::string(int bit)>& name_of,
                std::vector<JogEvent>& events) {
        for (std::uint64_t changed = mask ^ held_; changed != 0; changed &= changed - 1) {
            const int bit = std::countr_zero(changed);
            std::string name = name_of(bit);
            if (!name.empty())
                events.push_back({JogKind::button, std::move(name), (mask >> bit & 1) ? 1.0 : 0.0});
        }
        held_ = mask;
    }

  private:
    std::uint64_t held_ = 0;
};

/// Remembers axis positions and creates events only for axes that moved, since some devices repeat
/// themselves.
class AxisPosition {
  public:
    void update(double value, const std::string& name, std::vector<JogEvent>& events) {
        if (value != value_) events.push_back({JogKind::axis, name, value});
        value_ = value;
    }

  private:
    double value_ = 0;
};

/// All families, sorted by name.
std::vector<JogFamily> jog_families();

/// Creates a decoder for a device of a known family; null if there is none.
std::unique_ptr<JogDecoder> make_known_decoder(JogId id);

/// True if this family can read the node.
bool reads(const JogFamily& family, const JogPlace& place);

}  // namespace vantage

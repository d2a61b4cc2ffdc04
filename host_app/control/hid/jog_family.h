#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host_app/control/hid/jog_decoder.h"

namespace vantage {

enum class JogTransport {
    hidraw,  ///< through hidapi
    evdev,   ///< where a kernel driver has taken the device, or usbhid leaves it alone
};

/// USB ids, "0b33:0020".
struct JogId {
    std::uint16_t vendor = 0, product = 0;
    auto operator<=>(const JogId&) const = default;
};
std::string to_text(JogId id);
/// Throws Error for what is not VVVV:PPPP in hexadecimal.
JogId parse_jog_id(const std::string& text);

struct JogModel {
    JogId id;
    std::string name;
};

/// A device node that the system shows, open or not.
struct JogPlace {
    JogTransport transport = JogTransport::hidraw;
    std::string path;  ///< /dev/hidraw3
    JogId id;
    std::string name, serial;
    int interface_number = -1;                ///< of a USB device with several; -1: it does not say
    std::uint16_t usage_page = 0, usage = 0;  ///< of the HID collection; 0: it does not say

    bool same_node(const JogPlace& other) const { return path == other.path; }
};

/// Devices that speak alike. A family is one file, families/NAME_family.cpp, that defines
/// `JogFamily NAME_family_entry()`.
struct JogFamily {
    std::string name;
    JogTransport transport = JogTransport::hidraw;
    std::vector<JogModel> models;
    /// Which of a device's nodes speaks; empty: the one of its first interface.
    std::function<bool(const JogPlace&)> speaks;
    std::function<std::unique_ptr<JogDecoder>(JogId)> make_decoder;
};

/// All families, by name.
std::vector<JogFamily> jog_families();

/// A decoder for a device that a family reads; null if none does.
std::unique_ptr<JogDecoder> make_known_decoder(JogId id);

/// Whether the node is one that this family reads.
bool reads(const JogFamily& family, const JogPlace& place);

}  // namespace vantage

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

/// All families, sorted by name.
std::vector<JogFamily> jog_families();

/// Creates a decoder for a device of a known family; null if there is none.
std::unique_ptr<JogDecoder> make_known_decoder(JogId id);

/// True if this family can read the node.
bool reads(const JogFamily& family, const JogPlace& place);

}  // namespace vantage

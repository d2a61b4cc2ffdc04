#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host_app/control/table/lamp.h"

namespace vantage {

/// OSC 1.0 message, as far as commands use it.
struct OscMessage {
    std::string address;
    std::vector<double> numbers;          ///< numeric arguments: i, h, f, d, T (1) and F (0)
    std::vector<std::string> words = {};  ///< string arguments
    bool has_others = false;              ///< has arguments of other types
};

/// Decodes a datagram with one message or a bundle, in order; the times of bundles are ignored.
/// Empty if a part of it is not OSC.
std::optional<std::vector<OscMessage>> decode_osc(std::span<const std::byte> datagram);

/// Encodes a lamp: switches as the integers 1 and 0, numbers as floats.
std::vector<std::byte> encode_osc(const std::string& address, const LampValue& value);

}  // namespace vantage

#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host_app/control/table/lamp.h"

namespace vantage {

/// An OSC 1.0 message, as far as commands go.
struct OscMessage {
    std::string address;
    std::vector<double> numbers;          ///< of its arguments: i, h, f, d, T (1) and F (0)
    std::vector<std::string> words = {};  ///< of its strings
    bool has_others = false;              ///< arguments that are neither
};

/// The messages of a datagram, one or a bundle of them, in their order; times of bundles are not
/// waited for. Nothing: some of it is no OSC.
std::optional<std::vector<OscMessage>> decode_osc(std::span<const std::byte> datagram);

/// A message that says a lamp: on and off as the integers 1 and 0, numbers as floats.
std::vector<std::byte> encode_osc(const std::string& address, const LampValue& value);

}  // namespace vantage

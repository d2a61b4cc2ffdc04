#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace vantage {

/// A rig announced on the network.
struct FoundRig {
    std::string name;
    std::string host;      ///< its address; IPv6 in brackets
    int pairing_port = 0;  ///< 0: not open for pairing
    int stream_port = 0;   ///< 0: streams to programs on its own computer only
    bool operator==(const FoundRig&) const = default;
};

/// Browses for rigs by DNS-SD through Avahi for `time`, and returns them sorted by name. Throws
/// Error if avahi-daemon is not available; rigs are then given by their addresses.
std::vector<FoundRig> find_rigs(std::chrono::milliseconds time,
                                const std::function<bool()>& is_stopped);

}  // namespace vantage

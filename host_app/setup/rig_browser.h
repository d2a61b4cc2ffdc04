#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace vantage {

/// A rig that announces itself on the network.
struct FoundRig {
    std::string name;
    std::string host;      ///< its address; IPv6 in brackets
    int pairing_port = 0;  ///< 0: it is not open for pairing
    int stream_port = 0;   ///< 0: it streams to nobody but its own computer
    bool operator==(const FoundRig&) const = default;
};

/// Looks so long for rigs that announce themselves by DNS-SD, through Avahi; by name. Throws Error
/// where this computer cannot look: without avahi-daemon rigs are found by their addresses.
std::vector<FoundRig> find_rigs(std::chrono::milliseconds time,
                                const std::function<bool()>& is_stopped);

}  // namespace vantage

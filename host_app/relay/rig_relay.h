#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/config/stage_config.h"
#include "common/serve/host_links.h"

namespace vantage {

/// Forwards the frames of a stage's rigs to any number of hosts. It is one host to the rigs, and
/// serves hosts as the rigs would, so that a rig's uplink carries each frame once and only on
/// request. Frames are forwarded byte for byte, without decoding. A slow host loses its oldest
/// frames, which are counted, and delays neither rigs nor other hosts. Losses between rig and relay
/// are added to every host's account. Keys are checked on both sides. Raw pairs and rigs' own
/// recordings are not forwarded. Thread-safe.
class RigRelay {
  public:
    struct Settings {
        /// tcp://HOST:PORT for the first rig; further rigs get the following ports. Port "*": free
        /// ports.
        std::string listen;
        std::filesystem::path authorized_hosts{};  ///< empty: no keys towards hosts, on loopback
        int queue_frames = 4;                      ///< frames per rig that may wait for one host
    };

    /// The key in the stage's key_file identifies the relay to rigs and hosts. Throws Error if a
    /// key, a list or an endpoint is invalid.
    RigRelay(const StageConfig& stage, const Settings& settings);
    ~RigRelay();

    struct Rig {
        std::string name;
        std::string endpoint;    ///< of this relay, for hosts
        std::string public_key;  ///< of this relay, for hosts; empty: none
        bool connected = false;
        std::string trouble;            ///< why it is not connected, if known
        std::uint64_t frames = 0;       ///< received
        std::uint64_t bytes = 0;        ///< received
        std::uint64_t dropped = 0;      ///< dropped by the rig for this relay, or lost
        std::uint64_t undecodable = 0;  ///< invalid messages
        std::vector<HostLinks::HostStatus> hosts{};
    };
    /// In the order of the stage. Throws Error if relaying ended.
    std::vector<Rig> status() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage

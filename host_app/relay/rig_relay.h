#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/config/stage_config.h"
#include "common/serve/host_links.h"

namespace vantage {

/// Takes part in a stage as one host towards its rigs, and serves any number of hosts as the rigs
/// would: a rig's uplink carries each frame once, and each only if a host asks for it. Frames are
/// passed on as they came, byte for byte, not decoded. A host that is slow loses its oldest frames,
/// which are counted, and holds up neither rigs nor other hosts. What is dropped between rig and
/// relay is in the account of every host. Keys are checked on both sides: by the rigs, and here.
/// Raw pairs, and what rigs keep, are not passed on. Thread-safe.
class RigRelay {
  public:
    struct Settings {
        /// tcp://HOST:PORT of the first rig; the next ones have the ports that follow. Port "*":
        /// any free ones.
        std::string listen;
        std::filesystem::path authorized_hosts{};  ///< empty: no keys towards hosts, on loopback
        int queue_frames = 4;                      ///< that may wait for one host, a rig
    };

    /// The stage's key_file is whose key rigs and hosts know the relay by. Throws Error if a key,
    /// a list or an endpoint is unusable.
    RigRelay(const StageConfig& stage, const Settings& settings);
    ~RigRelay();

    struct Rig {
        std::string name;
        std::string endpoint;    ///< where hosts reach it here
        std::string public_key;  ///< that hosts know it by here; empty: none
        bool connected = false;
        std::string trouble;            ///< why not, as far as it is known
        std::uint64_t frames = 0;       ///< that came
        std::uint64_t bytes = 0;        ///< of those
        std::uint64_t dropped = 0;      ///< that the rig dropped on the way here, or that got lost
        std::uint64_t undecodable = 0;  ///< messages that were none
        std::vector<HostLinks::HostStatus> hosts{};
    };
    /// In the order of the stage. Throws Error if relaying came to an end.
    std::vector<Rig> status() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage

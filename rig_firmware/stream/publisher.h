#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/config/rig_config.h"
#include "common/serve/host_links.h"
#include "common/wire/frame_message.h"

namespace vantage {

struct PublisherStatus {
    RigCounters counters;  ///< the daemon's last, with `published` and `send_dropped`
    std::vector<HostLinks::HostStatus> hosts;
    std::uint64_t malformed = 0;            ///< messages that were no host's
    std::uint64_t refused_fetches = 0;      ///< of hosts, where this rig keeps nothing
    std::uint64_t refused_connections = 0;  ///< of strangers
};

/// The frame holds a value that may not travel: this frame is lost, and publishing goes on.
class FrameRefused : public Error {
  public:
    using Error::Error;
};

/// The first frame that is kept of the pulses `from` to before `to`; null if none is. May take its
/// time: it is called on a thread that has nothing else to do.
using KeptLookup =
    std::function<std::shared_ptr<const KeptParts>(std::uint64_t from, std::uint64_t to)>;

/// What the rig says of itself for help, at most max_report_bytes. May take its time, as above, but
/// no longer once it is to stop.
using ReportMaker = std::function<std::string(const std::atomic<bool>& stopping)>;

/// Offers a rig's frames to any number of hosts. Each is sent frames as fast as it takes them and
/// no faster: a slow one loses its oldest waiting frames, which are counted, and holds up neither
/// the rig nor another host. With keys, only authorized hosts get in and everything is encrypted;
/// without, only programs on this computer can be served.
class Publisher {
  public:
    /// Throws Error if the endpoint cannot be bound, a key or list cannot be read, or an endpoint
    /// beyond loopback is asked for without keys.
    Publisher(const RigConfig::Stream& config, std::string rig_name);
    ~Publisher();

    /// Packs on the calling thread and never waits for the network. `rig`, `session`, `published`,
    /// pack_ms and two of the counters are filled in here. Throws FrameRefused naming the first
    /// value of the frame that may not travel, or Error, why publishing came to an end. A raw pair
    /// that no host asks for is not packed, and null returned; else the packed frame. One thread at
    /// a time.
    std::shared_ptr<const PackedFrame> publish(RigFrame frame);

    /// A host asks for the raw pair of this pulse. Any thread.
    bool wants_raw_pair(std::uint64_t trigger_index) const;

    /// The rig has no views: hosts that ask for them are refused with this reason, and publish() is
    /// given raw pairs only.
    void serve_raw_pairs_only(std::string reason);

    /// From now on hosts may fetch what this rig keeps. Once.
    void serve_kept(KeptLookup lookup);

    /// From now on hosts may ask for a report. Once.
    void serve_reports(ReportMaker make);

    /// Tells hosts the daemon's counts (captured, missed, late) also while no frame is published.
    /// Any thread.
    void report(const RigCounters& counters);

    /// Tells hosts, in every message and frame, how this rig stands to clock and pulses. Any
    /// thread.
    void report(const RigSync& sync);
    /// And how its computer and its calibration are. Any thread.
    void report(const RigHealth& health);

    /// The first pulse of the take as a host last announced it; 0: none did. Any thread.
    std::uint64_t announced_pulse() const;

    PublisherStatus status() const;

    /// Random per start.
    std::uint64_t session() const;
    /// With the port that was bound, where the configuration left it open.
    std::string endpoint() const;
    /// Z85; empty without keys.
    std::string public_key() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage

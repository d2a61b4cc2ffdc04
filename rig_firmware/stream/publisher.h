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
    RigCounters counters;  ///< last counters of the daemon, with `published` and `send_dropped`
    std::vector<HostLinks::HostStatus> hosts;
    std::uint64_t malformed = 0;  ///< messages that do not follow the protocol
    std::uint64_t refused_fetches =
        0;  ///< fetch requests from hosts while this rig records nothing
    std::uint64_t refused_connections = 0;  ///< connections without an authorized key
};

/// Error for a frame with a value that the wire format forbids. The frame is lost; publishing
/// continues.
class FrameRefused : public Error {
  public:
    using Error::Error;
};

/// Returns the first recorded frame whose pulse is at least `from` and below `to`; null if there is
/// none. It may block: the publisher calls it on a separate thread.
using KeptLookup =
    std::function<std::shared_ptr<const KeptParts>(std::uint64_t from, std::uint64_t to)>;

/// Returns the rig's support report, at most max_report_bytes. It may block until `stopping` is
/// true.
using ReportMaker = std::function<std::string(const std::atomic<bool>& stopping)>;

/// Network server that sends a rig's frames to any number of hosts. Each host gets frames as fast
/// as it takes them: a slow one loses its oldest waiting frames, which are counted, and delays
/// neither the rig nor another host. With keys, only authorized hosts can connect and everything is
/// encrypted; without keys, only programs on this computer can connect.
class Publisher {
  public:
    /// Throws Error if the endpoint cannot be bound, if a key or a list of keys cannot be read, or
    /// if the endpoint is beyond loopback without keys.
    Publisher(const RigConfig::Stream& config, std::string rig_name);
    ~Publisher();

    /// Packs a frame on the calling thread and queues it; never waits for the network. Fills in
    /// `rig`, `session`, `published`, pack_ms and two of the counters. Returns the packed frame, or
    /// null for a raw pair that no host asks for. Throws FrameRefused with the first forbidden
    /// value of the frame, or the Error that ended publishing. Call it from one thread at a time.
    std::shared_ptr<const PackedFrame> publish(RigFrame frame);

    /// True if a host asks for the raw pair of this pulse. Any thread.
    bool wants_raw_pair(std::uint64_t trigger_index) const;

    /// Declares that the rig has no views: requests for views are refused with this reason, and
    /// publish() gets raw pairs only.
    void serve_raw_pairs_only(std::string reason);

    /// Lets hosts fetch recorded frames from now on. Call it at most once.
    void serve_kept(KeptLookup lookup);

    /// Lets hosts ask for a support report from now on. Call it at most once.
    void serve_reports(ReportMaker make);

    /// Sends the daemon's counters (captured, missed, late) to hosts, also while no frame is
    /// published. Any thread.
    void report(const RigCounters& counters);

    /// Sends the rig's clock and pulse state to hosts, in every message and frame. Any thread.
    void report(const RigSync& sync);
    /// Sends the health of the rig's computer and calibration to hosts. Any thread.
    void report(const RigHealth& health);

    /// First pulse of the stage, as a host last announced it; 0 if none did. Any thread.
    std::uint64_t announced_pulse() const;

    PublisherStatus status() const;

    /// Random number of this start of the rig.
    std::uint64_t session() const;
    /// Endpoint with the port that was bound, also if the configuration left the port open.
    std::string endpoint() const;
    /// Public key in Z85; empty without keys.
    std::string public_key() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage

#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/time/time.h"
#include "common/datagrams/datagram_server.h"
#include "common/wire/frame_codec.h"
#include "common/wire/kept_parts.h"
#include "common/wire/link_message.h"

namespace vantage {

/// Distributes the frames of a rig to its hosts and accounts for each of them, in a rig's publisher
/// or a relay. It has no sockets, clocks or threads of its own. Not thread-safe.
///
/// A host is identified by its key and the id it chose; it keeps its link and counts when it
/// reconnects. It is sent a frame only while it has credit. Further frames wait in the host's own
/// queue; when that is full, the oldest frame is dropped and counted.
class HostLinks {
  public:
    /// ZeroMQ's routing id of a connection.
    using Route = std::string;

    struct Outgoing {
        Route route;
        RigMessage message;
        std::shared_ptr<const PackedFrame> frame;  ///< null, like `kept`: heartbeat or refusal
        std::shared_ptr<const KeptParts> kept = nullptr;      ///< a frame that the host fetches
        std::shared_ptr<const std::string> report = nullptr;  ///< requested by the host
        bool by_datagrams = false;  ///< the frame goes on the host's road of datagrams
    };

    struct HostStatus {
        std::string host_key;  ///< in Z85; empty without keys
        bool attached = false;
        LinkCounters counters;
        std::size_t queued = 0;
        std::uint64_t fetched = 0;  ///< frames of the rig's own recording sent to it
        bool streaming = false;     ///< whether it asks for frames
        bool by_datagrams = false;  ///< whether its road of datagrams is open
    };

    /// A lookup of the next frame that a host fetches: the first recorded one of these pulses.
    struct FetchJob {
        std::uint64_t link = 0, fetch = 0;
        std::uint64_t from_pulse = 0, to_pulse = 0;
    };

    /// The number of hosts at a time, and of remembered ones.
    static constexpr std::size_t max_hosts = 16;

    HostLinks(std::string rig, std::uint64_t session, std::size_t queue_frames);

    /// Queues a published frame for every attached host that asks for its kind.
    void offer(std::shared_ptr<const PackedFrame> frame);

    /// Queues a frame that came from the rig over the relay's own link.
    void pass_on(const std::shared_ptr<const PackedFrame>& frame);
    /// Takes in the rig's message to the relay. Waiting frames of an earlier session are dropped
    /// and counted.
    void relay(std::uint64_t session, const RigCounters& counters, RigSync sync, RigHealth health);
    /// Counts frames that the rig published but the relay did not get: dropped on the way, or
    /// skipped at the relay's request. They are added to the account of every attached host.
    void miss(std::uint64_t dropped, std::uint64_t skipped);
    /// Why the relay gets nothing from the rig; hosts get it instead of heartbeats. Empty: it does.
    void set_away(std::string reason) { away_ = std::move(reason); }
    /// From now on refuses hosts that ask for raw pairs, with this reason.
    void serve_views_only(std::string reason) { no_raw_pairs_ = std::move(reason); }

    /// The combined request of all attached hosts.
    struct Demand {
        bool streaming = false;
        std::uint32_t rate_divisor = 1;
    };
    Demand demand() const;

    /// Whether an attached host asks for the raw pair of this pulse.
    bool wants_raw_pair(std::uint64_t trigger_index) const;

    /// From now on refuses hosts that ask for views, with this reason, and publishes raw pairs
    /// only.
    void serve_raw_pairs_only(std::string reason) { no_views_ = std::move(reason); }
    bool serves_raw_pairs_only() const { return !no_views_.empty(); }

    /// From now on hosts may fetch this rig's own recordings. Initially refused.
    void serve_kept() { no_kept_.clear(); }
    /// Refuses fetches with this reason.
    void serve_no_kept(std::string reason) { no_kept_ = std::move(reason); }
    /// The lookup for the next host in turn that has credit for a frame; empty if none has. Answer
    /// it with fetched().
    std::optional<FetchJob> next_fetch();
    /// Answers a lookup. `kept` is null if none of the pulses is recorded. `trouble`: a sentence if
    /// the lookup failed. Ignored if the host has changed its request meanwhile.
    void fetched(const FetchJob& job, std::shared_ptr<const KeptParts> kept, std::string trouble);
    /// Whether a host waits for a report.
    bool wants_report() const;
    /// Sends the report to all hosts that wait for one.
    void reported(std::shared_ptr<const std::string> report);
    /// Number of fetches refused because the rig keeps no recordings.
    std::uint64_t refused_fetches() const { return refused_fetches_; }

    /// Counts a raw pair as published that no host asked for, so that it was not packed.
    void pass_over() { ++rig_counters_.published; }

    /// Takes in a host's message: attaches the host or moves its link to this route, and updates
    /// its credit.
    void hear(const Route& route, const std::string& host_key, const HostMessage& message,
              MonotonicTime now);

    /// Removes the hosts with this key.
    void dismiss(const std::string& host_key);

    /// Sends a refusal to the sender of an invalid message.
    void refuse(const Route& route, std::string sentence, bool passes = false);

    /// Removes hosts that were silent for too long.
    void expire(MonotonicTime now);

    /// The attached hosts that ask for frames, or have a road from when they did.
    std::vector<DatagramServer::Peer> datagram_peers() const;
    /// Sets the roads of these peers. Other hosts have none.
    void set_roads(const std::vector<DatagramServer::Peer>& peers,
                   const std::vector<DatagramServer::Road>& roads);
    /// Whether a frame waits until a road of datagrams has room.
    bool waits_for_room() const;

    /// Schedules a heartbeat to every attached host.
    void ring();

    /// Returns the messages to send now, in order: refusals, heartbeats, frames within credit.
    /// Counts the frames as sent.
    std::vector<Outgoing> take();

    /// Reports that a message was not sent: counts a frame as dropped instead of sent, and removes
    /// its host unless the message was for a road of datagrams, which has ended. Precondition: no
    /// later message for the same route or road was sent.
    void undelivered(const Outgoing& outgoing);

    /// Sets the daemon's counts for heartbeats, except `published` and `send_dropped`, which are
    /// counted here.
    void set_rig_counters(const RigCounters& counters);
    RigCounters rig_counters() const;
    /// Sets the number of refused connections of this socket, added to those in the rig's health.
    void set_refused_connections(std::uint64_t count) { refused_connections_ = count; }
    /// Sets the state that heartbeats and messages report.
    void set_sync(RigSync sync) { sync_ = std::move(sync); }
    const RigSync& sync() const { return sync_; }
    void set_health(RigHealth health) { health_ = std::move(health); }
    const RigHealth& health() const { return health_; }

    std::vector<HostStatus> hosts() const;

    /// Frames dropped for newer ones since the last call, because hosts were too slow.
    struct Overrun {
        std::uint64_t frames = 0;
        std::string host;  ///< the host of the last one, for people
    };
    Overrun take_overrun();

  private:
    struct Fetch {
        FetchRequest request;
        std::uint64_t next_pulse = 0;  ///< all pulses before it are sent, ready, or not recorded
        std::uint64_t sent = 0;
        bool is_looked_up = false;  ///< a lookup is running
        bool is_searched = false;   ///< nothing is recorded from next_pulse on
        std::string trouble;
        std::deque<std::shared_ptr<const KeptParts>> ready;
        bool is_over() const { return is_searched && ready.empty(); }
    };
    struct Link {
        Route route;
        std::string host_key;
        std::uint64_t host_id = 0;
        std::uint64_t id = 0;
        bool attached = false;
        bool heartbeat_due = false;
        bool streaming = true;
        bool raw_pairs = false;
        std::uint32_t rate_divisor = 1;
        std::uint64_t credit_limit = 0;  ///< total frames of this link that may be sent
        LinkCounters counters;
        std::uint64_t sent_by_datagrams = 0;  ///< of those sent
        DatagramAnswer answer;
        DatagramServer::Road road;
        MonotonicTime heard{};
        std::deque<std::shared_ptr<const PackedFrame>> queue;
        std::optional<Fetch> fetch;
        std::uint64_t fetched = 0;
        std::uint64_t report_asked = 0, report_sent = 0;  ///< ids
        std::shared_ptr<const std::string> report;        ///< waits to be sent
    };

    Link* find(const std::string& host_key, std::uint64_t host_id);
    Link* take_on(const std::string& host_key, std::uint64_t host_id);
    void let_go(Link& link);
    void drop_oldest(Link& link);
    /// The road of a frame; `wait`: until there is room.
    enum class Way { tcp, datagrams, wait };
    static Way way_of(const Link& link, const PackedFrame& frame);
    void hear_fetch(Link& link, const std::optional<FetchRequest>& request);
    RigMessage message_to(const Link& link) const;

    std::string rig_;
    std::uint64_t session_;
    std::size_t queue_frames_;
    std::string no_views_, no_raw_pairs_, no_kept_;  ///< reasons for a refusal; empty: served
    std::string away_;
    RigCounters rig_counters_;        ///< as reported by the rig, without drops counted here
    std::uint64_t dropped_here_ = 0;  ///< in this session
    RigSync sync_;
    RigHealth health_;
    std::uint64_t refused_connections_ = 0;
    std::uint64_t refused_fetches_ = 0;
    std::uint64_t last_served_ = 0;  ///< the link of the last lookup
    std::vector<Link> links_;
    std::vector<Outgoing> refusals_;
    Overrun overrun_;
};

}  // namespace vantage

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
#include "common/wire/frame_codec.h"
#include "common/wire/kept_parts.h"
#include "common/wire/link_message.h"

namespace vantage {

/// Who gets which frame of a rig, and what became of every one of them: the books of a rig's
/// publisher, or of a relay that serves in its place, without sockets, clocks or threads of their
/// own.
///
/// A host is named by its key and the id it chose; it keeps its link, and the link's count, when it
/// comes back on another connection. It is sent a frame only while it has credit; beyond that its
/// frames wait in a queue of its own, and when that is full the oldest makes room and is counted.
class HostLinks {
  public:
    /// The socket's name for a connection.
    using Route = std::string;

    struct Outgoing {
        Route route;
        RigMessage message;
        std::shared_ptr<const PackedFrame> frame;  ///< null, as `kept`: a heartbeat or refusal
        std::shared_ptr<const KeptParts> kept = nullptr;      ///< one that the host fetches
        std::shared_ptr<const std::string> report = nullptr;  ///< that the host asked for
    };

    struct HostStatus {
        std::string host_key;  ///< Z85; empty without keys
        bool attached = false;
        LinkCounters counters;
        std::size_t queued = 0;
        std::uint64_t fetched = 0;  ///< frames of the rig's own take that it was sent
        bool streaming = false;     ///< it asks for frames
    };

    /// The next frame that a host fetches: of these pulses the first that is kept.
    struct FetchJob {
        std::uint64_t link = 0, fetch = 0;
        std::uint64_t from_pulse = 0, to_pulse = 0;
    };

    /// Hosts at a time, and remembered ones among them.
    static constexpr std::size_t max_hosts = 16;

    HostLinks(std::string rig, std::uint64_t session, std::size_t queue_frames);

    /// The rig has published a frame: for every attached host that asks for its kind.
    void offer(std::shared_ptr<const PackedFrame> frame);

    /// The same of a frame that came from the rig over a link of the relay's own.
    void pass_on(const std::shared_ptr<const PackedFrame>& frame);
    /// What the rig said to the relay. Frames of a session before that still wait are dropped and
    /// counted.
    void relay(std::uint64_t session, const RigCounters& counters, RigSync sync, RigHealth health);
    /// Frames that the rig published and that never came to the relay: dropped on the way, and left
    /// out as the relay asked. They are in the account of every attached host.
    void miss(std::uint64_t dropped, std::uint64_t skipped);
    /// Why the rig gives the relay nothing, which its hosts are told instead of heartbeats; empty:
    /// it does.
    void set_away(std::string reason) { away_ = std::move(reason); }
    /// From now on hosts that ask for raw pairs are refused with this reason.
    void serve_views_only(std::string reason) { no_raw_pairs_ = std::move(reason); }

    /// What all attached hosts together ask for.
    struct Demand {
        bool streaming = false;
        std::uint32_t rate_divisor = 1;
    };
    Demand demand() const;

    /// An attached host asks for the raw pair of this pulse.
    bool wants_raw_pair(std::uint64_t trigger_index) const;

    /// From now on hosts that ask for views are refused with this reason, and what is published are
    /// raw pairs.
    void serve_raw_pairs_only(std::string reason) { no_views_ = std::move(reason); }
    bool serves_raw_pairs_only() const { return !no_views_.empty(); }

    /// From now on hosts may fetch what this rig keeps; before, they are told that it keeps
    /// nothing.
    void serve_kept() { no_kept_.clear(); }
    /// They are told this.
    void serve_no_kept(std::string reason) { no_kept_ = std::move(reason); }
    /// The job of the host whose turn it is, of those that have credit for one; nothing if none
    /// has. It is done with fetched().
    std::optional<FetchJob> next_fetch();
    /// Null: none of the job's pulses is kept. `trouble`: a sentence, where that cannot be found
    /// out. For a host that wants something else by now it is forgotten.
    void fetched(const FetchJob& job, std::shared_ptr<const KeptParts> kept, std::string trouble);
    /// A host asks for a report and has not got it.
    bool wants_report() const;
    /// To every such host.
    void reported(std::shared_ptr<const std::string> report);
    /// Fetches that were refused since this rig keeps nothing.
    std::uint64_t refused_fetches() const { return refused_fetches_; }

    /// A raw pair of a rig that has nothing else was not packed, since nobody asks for it.
    void pass_over() { ++rig_counters_.published; }

    /// Takes the host on, or moves its link to this route, and grants it credit.
    void hear(const Route& route, const std::string& host_key, const HostMessage& message,
              MonotonicTime now);

    /// Answers a message that was refused before it got here.
    void refuse(const Route& route, std::string sentence, bool passes = false);

    /// Lets go of hosts that were silent for too long.
    void expire(MonotonicTime now);

    /// A heartbeat to every attached host is due.
    void ring();

    /// What is to be sent now, in order: refusals, heartbeats, frames within credit. Counts the
    /// frames as sent.
    std::vector<Outgoing> take();

    /// The socket could not take this one: its host is let go, and a frame counts as dropped
    /// instead of sent. Precondition: nothing taken after it for the same route was delivered.
    void undelivered(const Outgoing& outgoing);

    /// The daemon's counts, as heartbeats report them; `published` and `send_dropped` are kept
    /// here.
    void set_rig_counters(const RigCounters& counters);
    RigCounters rig_counters() const;
    /// Connections of strangers to this socket: reported beside those that the health has already.
    void set_refused_connections(std::uint64_t count) { refused_connections_ = count; }
    /// As heartbeats and messages report it.
    void set_sync(RigSync sync) { sync_ = std::move(sync); }
    const RigSync& sync() const { return sync_; }
    void set_health(RigHealth health) { health_ = std::move(health); }
    const RigHealth& health() const { return health_; }

    std::vector<HostStatus> hosts() const;

    /// Frames since the last call that made room for newer ones, as hosts were too slow for them.
    struct Overrun {
        std::uint64_t frames = 0;
        std::string host;  ///< the one that lost the last of them, for people
    };
    Overrun take_overrun();

  private:
    struct Fetch {
        FetchRequest request;
        std::uint64_t next_pulse = 0;  ///< all before it are sent, ready, or not kept
        std::uint64_t sent = 0;
        bool is_looked_up = false;  ///< a job is under way
        bool is_searched = false;   ///< nothing of the wish is kept from next_pulse on
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
        std::uint64_t credit_limit = 0;  ///< frames of this link that may be sent in all
        LinkCounters counters;
        MonotonicTime heard{};
        std::deque<std::shared_ptr<const PackedFrame>> queue;
        std::optional<Fetch> fetch;
        std::uint64_t fetched = 0;
        std::uint64_t report_asked = 0, report_sent = 0;  ///< ids
        std::shared_ptr<const std::string> report;        ///< to be sent
    };

    Link* find(const std::string& host_key, std::uint64_t host_id);
    Link* take_on(const std::string& host_key, std::uint64_t host_id);
    void let_go(Link& link);
    void drop_oldest(Link& link);
    void hear_fetch(Link& link, const std::optional<FetchRequest>& request);
    RigMessage message_to(const Link& link) const;

    std::string rig_;
    std::uint64_t session_;
    std::size_t queue_frames_;
    std::string no_views_, no_raw_pairs_, no_kept_;  ///< why; empty: these are served
    std::string away_;
    RigCounters rig_counters_;        ///< as the rig says, but for what is dropped here
    std::uint64_t dropped_here_ = 0;  ///< of this session
    RigSync sync_;
    RigHealth health_;
    std::uint64_t refused_connections_ = 0;
    std::uint64_t refused_fetches_ = 0;
    std::uint64_t last_served_ = 0;  ///< the link whose job was the last
    std::vector<Link> links_;
    std::vector<Outgoing> refusals_;
    Overrun overrun_;
};

}  // namespace vantage

#include "common/serve/host_links.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/wire/limits.h"
#include "common/wire/random_id.h"

namespace vantage {
namespace {

/// A host keeps its queue while it is busy, and loses it after this silence.
constexpr auto silence_limit = 2 * liveness_limit;

/// Refusals that wait for the socket; further ones are not sent, so that a flood is not answered.
constexpr std::size_t max_refusals = 32;

/// More than an encoded RigMessage takes, for the room of a frame's message.
constexpr std::size_t room_of_head = max_header_bytes;

std::size_t room_for(const PackedFrame& frame) {
    return message_bytes_of(room_of_head + frame.bytes());
}

std::string display_name(const std::string& host_key) {
    return host_key.empty() ? "a host without key" : "host " + host_key;
}

}  // namespace

HostLinks::HostLinks(std::string rig, std::uint64_t session, std::size_t queue_frames)
    : rig_(std::move(rig)),
      session_(session),
      queue_frames_(std::max<std::size_t>(queue_frames, 1)),
      no_kept_(fmt::format("rig {} keeps no take of its own: set folder in [keep] of its rig.toml",
                           rig_)) {}

void HostLinks::offer(std::shared_ptr<const PackedFrame> frame) {
    // A raw pair beside a view of the same pulse does not count as published a second time.
    if (!frame->is_raw_pair || serves_raw_pairs_only()) ++rig_counters_.published;
    pass_on(frame);
}

void HostLinks::pass_on(const std::shared_ptr<const PackedFrame>& frame) {
    for (Link& link : links_) {
        if (!link.attached || link.raw_pairs != frame->is_raw_pair) continue;
        ++link.counters.offered;
        if (!link.streaming || frame->trigger_index % link.rate_divisor != 0) {
            ++link.counters.skipped;
            continue;
        }
        if (link.queue.size() == queue_frames_) {
            drop_oldest(link);
            ++overrun_.frames;
            overrun_.host = display_name(link.host_key);
        }
        link.queue.push_back(frame);
    }
}

void HostLinks::relay(std::uint64_t session, const RigCounters& counters, RigSync sync,
                      RigHealth health) {
    if (session != session_) {
        for (Link& link : links_)
            while (!link.queue.empty()) drop_oldest(link);
        session_ = session;
        dropped_here_ = 0;
    }
    rig_counters_ = counters;
    sync_ = std::move(sync);
    health_ = std::move(health);
}

void HostLinks::miss(std::uint64_t dropped, std::uint64_t skipped) {
    for (Link& link : links_) {
        if (!link.attached) continue;
        link.counters.offered += dropped + skipped;
        link.counters.send_dropped += dropped;
        link.counters.skipped += skipped;
    }
}

HostLinks::Demand HostLinks::demand() const {
    Demand demand{false, 0};
    for (const Link& link : links_) {
        if (!link.attached || !link.streaming) continue;
        demand.streaming = true;
        demand.rate_divisor = std::gcd(demand.rate_divisor, link.rate_divisor);
    }
    demand.rate_divisor = std::max(demand.rate_divisor, 1u);
    return demand;
}

bool HostLinks::wants_raw_pair(std::uint64_t trigger_index) const {
    return std::any_of(links_.begin(), links_.end(), [&](const Link& link) {
        return link.attached && link.raw_pairs && link.streaming &&
               trigger_index % link.rate_divisor == 0;
    });
}

void HostLinks::hear(const Route& route, const std::string& host_key, const HostMessage& message,
                     MonotonicTime now) {
    if (serves_raw_pairs_only() && message.streaming && !message.raw_pairs) {
        refuse(route, no_views_);
        return;
    }
    if (!no_raw_pairs_.empty() && message.streaming && message.raw_pairs) {
        refuse(route, no_raw_pairs_);
        return;
    }
    Link* link = find(host_key, message.host_id);
    if (!link) link = take_on(host_key, message.host_id);
    if (!link) {
        refuse(route,
               fmt::format("rig {} serves {} hosts already and takes no more", rig_, max_hosts));
        return;
    }
    if (!link->attached) log_info("{} is attached", display_name(host_key));
    link->attached = true;
    link->route = route;
    link->heard = now;
    link->streaming = message.streaming;
    link->raw_pairs = message.raw_pairs;
    link->rate_divisor = message.rate_divisor;
    const std::uint32_t most = link->road.is_open ? max_datagram_credit_window : max_credit_window;
    if (message.link == link->id)
        link->credit_limit =
            std::min(message.handled, link->counters.sent) + std::min(message.credit_window, most);
    else
        link->heartbeat_due = true;
    hear_fetch(*link, message.fetch);
    if (!away_.empty()) refuse(route, away_, true);
    link->report_asked = message.report_id;
    link->answer = message.datagrams;
}

std::vector<DatagramServer::Peer> HostLinks::datagram_peers() const {
    std::vector<DatagramServer::Peer> peers;
    for (const Link& link : links_)
        if (link.attached && (link.streaming || link.road.offer.id != 0))
            peers.push_back({link.id, display_name(link.host_key), link.answer});
    return peers;
}

void HostLinks::set_roads(const std::vector<DatagramServer::Peer>& peers,
                          const std::vector<DatagramServer::Road>& roads) {
    for (Link& link : links_) {
        const auto peer = std::find_if(peers.begin(), peers.end(),
                                       [&](const auto& each) { return each.link == link.id; });
        DatagramServer::Road road;
        if (peer != peers.end() && link.attached)
            road = roads[static_cast<std::size_t>(peer - peers.begin())];
        // The host learns at once of an offer, and of the end of a road.
        if (road.offer != link.road.offer && link.attached) link.heartbeat_due = true;
        link.road = std::move(road);
    }
}

HostLinks::Way HostLinks::way_of(const Link& link, const PackedFrame& frame) {
    const std::size_t room = room_for(frame);
    if (!link.road.is_open || room > max_datagram_message_bytes) return Way::tcp;
    return room <= link.road.room_bytes ? Way::datagrams : Way::wait;
}

bool HostLinks::waits_for_room() const {
    return std::any_of(links_.begin(), links_.end(), [](const Link& link) {
        return link.attached && !link.queue.empty() && link.counters.sent < link.credit_limit &&
               way_of(link, *link.queue.front()) == Way::wait;
    });
}

bool HostLinks::wants_report() const {
    return std::any_of(links_.begin(), links_.end(), [](const Link& link) {
        return link.attached && link.report_asked != link.report_sent;
    });
}

void HostLinks::reported(std::shared_ptr<const std::string> report) {
    for (Link& link : links_) {
        if (!link.attached || link.report_asked == link.report_sent) continue;
        link.report_sent = link.report_asked;
        if (link.report_asked != 0) link.report = report;
    }
}

void HostLinks::hear_fetch(Link& link, const std::optional<FetchRequest>& request) {
    if (!request) {
        link.fetch.reset();
        return;
    }
    if (!link.fetch || link.fetch->request.id != request->id) {
        link.fetch = Fetch{*request, request->from_pulse, 0, false, false, {}, {}};
        if (!no_kept_.empty()) {
            ++refused_fetches_;
            link.fetch->trouble = no_kept_;
            link.heartbeat_due = true;
        }
    }
    link.fetch->request.granted = std::min(request->granted, link.fetch->sent + max_credit_window);
}

std::optional<HostLinks::FetchJob> HostLinks::next_fetch() {
    // Round robin: start behind the link that was served last.
    const auto last = std::find_if(links_.begin(), links_.end(),
                                   [&](const Link& link) { return link.id == last_served_; });
    const auto behind =
        static_cast<std::size_t>(last == links_.end() ? 0 : last - links_.begin() + 1);
    for (std::size_t i = 0; i < links_.size(); ++i) {
        Link& link = links_[(behind + i) % links_.size()];
        if (!link.attached || !link.fetch) continue;
        Fetch& fetch = *link.fetch;
        if (fetch.is_looked_up || fetch.is_searched || !fetch.trouble.empty() ||
            fetch.sent + fetch.ready.size() >= fetch.request.granted)
            continue;
        fetch.is_looked_up = true;
        last_served_ = link.id;
        return FetchJob{link.id, fetch.request.id, fetch.next_pulse, fetch.request.to_pulse};
    }
    return std::nullopt;
}

void HostLinks::fetched(const FetchJob& job, std::shared_ptr<const KeptParts> kept,
                        std::string trouble) {
    for (Link& link : links_) {
        if (link.id != job.link || !link.fetch || link.fetch->request.id != job.fetch) continue;
        Fetch& fetch = *link.fetch;
        fetch.is_looked_up = false;
        fetch.trouble = std::move(trouble);
        if (kept) {
            fetch.next_pulse = kept->pulse + 1;
            fetch.is_searched = fetch.next_pulse >= fetch.request.to_pulse;
            fetch.ready.push_back(std::move(kept));
        } else {
            fetch.is_searched = fetch.trouble.empty();
            link.heartbeat_due = true;
        }
    }
}

void HostLinks::dismiss(const std::string& host_key) {
    for (Link& link : links_)
        if (link.attached && link.host_key == host_key) let_go(link);
}

void HostLinks::refuse(const Route& route, std::string sentence, bool passes) {
    if (refusals_.size() == max_refusals) return;
    RigMessage message;
    message.rig = rig_;
    message.session = session_;
    message.rig_counters = rig_counters();
    message.refusal = std::move(sentence);
    message.refusal_passes = passes;
    refusals_.push_back({route, std::move(message), nullptr});
}

void HostLinks::expire(MonotonicTime now) {
    for (Link& link : links_)
        if (link.attached && now - link.heard > silence_limit) {
            log_info("{} went silent and is removed", display_name(link.host_key));
            let_go(link);
        }
}

void HostLinks::ring() {
    for (Link& link : links_) link.heartbeat_due = link.attached;
}

std::vector<HostLinks::Outgoing> HostLinks::take() {
    std::vector<Outgoing> all = std::move(refusals_);
    refusals_.clear();
    for (Link& link : links_) {
        if (!link.attached) continue;
        if (link.heartbeat_due && away_.empty()) {
            RigMessage message = message_to(link);
            message.offer = link.road.offer;
            all.push_back({link.route, std::move(message), nullptr});
        }
        link.heartbeat_due = false;
        if (link.report) {
            RigMessage message = message_to(link);
            message.report_id = link.report_sent;
            all.push_back({link.route, std::move(message), nullptr, nullptr,
                           std::exchange(link.report, nullptr)});
        }
        while (!link.queue.empty() && link.counters.sent < link.credit_limit) {
            const Way way = way_of(link, *link.queue.front());
            if (way == Way::wait) break;
            std::shared_ptr<const PackedFrame> frame = std::move(link.queue.front());
            link.queue.pop_front();
            ++link.counters.sent;
            const bool by_datagrams = way == Way::datagrams;
            if (by_datagrams) {
                ++link.sent_by_datagrams;
                link.road.room_bytes -= room_for(*frame);
            }
            all.push_back(
                {link.route, message_to(link), std::move(frame), nullptr, nullptr, by_datagrams});
        }
        while (link.fetch && !link.fetch->ready.empty()) {
            std::shared_ptr<const KeptParts> kept = std::move(link.fetch->ready.front());
            link.fetch->ready.pop_front();
            ++link.fetch->sent;
            ++link.fetched;
            all.push_back({link.route, message_to(link), nullptr, std::move(kept)});
        }
    }
    return all;
}

void HostLinks::undelivered(const Outgoing& outgoing) {
    for (Link& link : links_) {
        if (link.id != outgoing.message.link) continue;
        if (outgoing.frame) {
            --link.counters.sent;
            ++link.counters.send_dropped;
            ++dropped_here_;
        }
        if (outgoing.by_datagrams) {
            --link.sent_by_datagrams;
            link.road.is_open = false;
            continue;
        }
        if (link.attached && link.route == outgoing.route) {
            log_info("{} disconnected", display_name(link.host_key));
            let_go(link);
        }
    }
}

void HostLinks::set_rig_counters(const RigCounters& counters) {
    // A frame carries the counts of the moment of its capture, which may precede the newest.
    rig_counters_.captured = std::max(rig_counters_.captured, counters.captured);
    rig_counters_.missed = std::max(rig_counters_.missed, counters.missed);
    rig_counters_.late = std::max(rig_counters_.late, counters.late);
}

RigCounters HostLinks::rig_counters() const {
    RigCounters counters = rig_counters_;
    counters.send_dropped += dropped_here_;
    return counters;
}

std::vector<HostLinks::HostStatus> HostLinks::hosts() const {
    std::vector<HostStatus> all;
    for (const Link& link : links_)
        all.push_back({link.host_key, link.attached, link.counters, link.queue.size(), link.fetched,
                       link.attached && link.streaming, link.attached && link.road.is_open});
    return all;
}

HostLinks::Overrun HostLinks::take_overrun() { return std::exchange(overrun_, {}); }

HostLinks::Link* HostLinks::find(const std::string& host_key, std::uint64_t host_id) {
    for (Link& link : links_)
        if (link.host_key == host_key && link.host_id == host_id) return &link;
    return nullptr;
}

HostLinks::Link* HostLinks::take_on(const std::string& host_key, std::uint64_t host_id) {
    if (links_.size() == max_hosts) {
        const auto longest_gone =
            std::min_element(links_.begin(), links_.end(), [](const Link& a, const Link& b) {
                return std::pair(a.attached, a.heard) < std::pair(b.attached, b.heard);
            });
        if (longest_gone->attached) return nullptr;
        links_.erase(longest_gone);
    }
    Link& link = links_.emplace_back();
    link.host_key = host_key;
    link.host_id = host_id;
    link.id = random_id();
    return &link;
}

void HostLinks::let_go(Link& link) {
    link.attached = false;
    link.fetch.reset();
    link.road = {};
    while (!link.queue.empty()) drop_oldest(link);
}

void HostLinks::drop_oldest(Link& link) {
    link.queue.pop_front();
    ++link.counters.send_dropped;
    ++dropped_here_;
}

RigMessage HostLinks::message_to(const Link& link) const {
    RigMessage message;
    message.rig = rig_;
    message.session = session_;
    message.link = link.id;
    message.counters = link.counters;
    message.rig_counters = rig_counters();
    message.sync = sync_;
    message.health = health_;
    message.health.refused_connections += refused_connections_;
    message.offer = {link.road.offer.id, link.road.offer.port, ""};
    message.sent_by_datagrams = link.sent_by_datagrams;
    message.datagram_trouble = link.road.trouble;
    if (link.fetch)
        message.fetch = FetchState{link.fetch->request.id, link.fetch->sent, link.fetch->is_over(),
                                   link.fetch->trouble};
    return message;
}

}  // namespace vantage

#include "common/serve/frame_server.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <span>
#include <string_view>
#include <utility>
#include <vector>
#include <zmq_addon.hpp>

#include <fmt/ranges.h>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/refused_inputs.h"
#include "common/base/time/kernel_clock.h"
#include "common/config/endpoint.h"
#include "common/config/socket_address.h"
#include "common/wire/curve_keys.h"
#include "common/wire/limits.h"
#include "common/wire/zmq_helpers.h"

namespace vantage {
namespace {

/// Credit bounds the frames on a connection; this limit only has to exceed it with its heartbeats.
constexpr int send_high_water_mark = 4 * static_cast<int>(max_credit_window);
constexpr int receive_high_water_mark = 64;
/// Bounds the messages received at a time, so that a host that floods does not stop frames.
constexpr int messages_per_turn = 64;
/// How often the thread looks whether a road of datagrams has room for a frame that waits.
constexpr std::chrono::milliseconds room_period{5};
/// How long a closing socket waits for hosts to receive. Without it, ZeroMQ aborts if a host leaves
/// while a frame is half sent (libzmq issue 3442).
constexpr std::chrono::milliseconds farewell{200};
/// The shortest time between two log lines about invalid messages, and about slow hosts.
constexpr std::chrono::seconds complaint_period{10};

/// The key of the sender, as HostAdmission admitted it; empty without keys.
std::string host_key_of(zmq::message_t& part) { return property_of(part, "User-Id"); }

std::string address_of(zmq::message_t& part) {
    const std::string address = property_of(part, "Peer-Address");
    if (address.empty()) return "an unknown address";
    // A socket for both families names an IPv4 peer so.
    constexpr std::string_view mapped = "::ffff:";
    return address.starts_with(mapped) ? address.substr(mapped.size()) : address;
}

/// The addresses of the host, as ZeroMQ takes them: of a name it binds one only, or takes it for
/// that of a network device. A name that does not resolve may be one.
std::vector<std::string> hosts_of(const Endpoint& wanted, const std::string& what) {
    if (wanted.host == "*" || wanted.ipv6) return {wanted.host};
    std::vector<std::string> hosts;
    try {
        constexpr int any_port = 1;
        for (const SocketAddress& address : resolve_all(wanted.host, any_port, what))
            hosts.push_back(address.host());
    } catch (const Error&) {
        return {wanted.host};
    }
    return hosts;
}

}  // namespace

FrameServer::FrameServer(const Settings& settings, std::string rig, std::uint64_t session)
    : rig_(std::move(rig)),
      links_(rig_, session, static_cast<std::size_t>(std::max(settings.queue_frames, 1))),
      complaints_(complaint_period),
      overruns_(complaint_period),
      router_(context_, zmq::socket_type::router),
      strangers_(context_, router_, rig_) {
    bind(settings);
    thread_ = std::thread([this] { run(); });
}

FrameServer::~FrameServer() {
    stopping_ = true;
    wake_.notify();
    thread_.join();
}

void FrameServer::check() const {
    const std::lock_guard lock(mutex_);
    if (!failure_.empty()) fail("publishing of rig {} ended: {}", rig_, failure_);
}

std::uint64_t FrameServer::malformed() const {
    const std::lock_guard lock(mutex_);
    return malformed_;
}

void FrameServer::bind(const Settings& settings) {
    const Endpoint wanted = parse_endpoint(settings.bind, settings.bind_option);
    router_.set(zmq::sockopt::linger, option_ms(farewell));
    router_.set(zmq::sockopt::router_mandatory, true);
    router_.set(zmq::sockopt::sndhwm, send_high_water_mark);
    router_.set(zmq::sockopt::rcvhwm, receive_high_water_mark);
    router_.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(max_header_bytes));
    router_.set(zmq::sockopt::handshake_ivl, option_ms(StrangerWatch::handshake_limit));
    watch_for_dead_connections(router_);
    const std::vector<std::string> hosts = hosts_of(wanted, settings.bind_option);
    if (!settings.key_file.empty()) {
        const CurveKeys keys = load_key_file(settings.key_file);
        public_key_ = keys.public_key;
        admission_.emplace(context_, settings.authorized_hosts);
        strangers_.expect_keys();
        router_.set(zmq::sockopt::zap_domain, "vantage");
        router_.set(zmq::sockopt::curve_server, true);
        router_.set(zmq::sockopt::curve_secretkey, keys.secret_key);
    } else if (!wanted.loopback) {
        fail("{} = \"{}\" can be reached from other computers, which needs keys",
             settings.bind_option, settings.bind);
    }
    std::string port = wanted.port, failures;
    std::vector<std::string> endpoints;
    for (const std::string& host : hosts) {
        try {
            // "*" listens on both families.
            router_.set(zmq::sockopt::ipv6, host.starts_with('[') || host == "*");
            router_.bind(fmt::format("tcp://{}:{}", host, port));
        } catch (const zmq::error_t& error) {
            if (error.num() == EADDRINUSE)
                fail("port {} of {} is in use by another program; end it or choose another {}",
                     port, host, settings.bind_option);
            failures += fmt::format("{}{} ({})", failures.empty() ? "" : ", ", host, error.what());
            continue;
        }
        const std::string bound = router_.get(zmq::sockopt::last_endpoint);
        if (endpoint_.empty()) endpoint_ = bound;
        endpoints.push_back(bound);
        // The other addresses get the port that the first one was given.
        port = bound.substr(bound.rfind(':') + 1);
    }
    if (endpoint_.empty())
        fail("{} = \"{}\" cannot be bound: {}", settings.bind_option, settings.bind, failures);
    if (!failures.empty())
        log_info("{} = \"{}\" is not bound at {}", settings.bind_option, settings.bind, failures);
    if (hosts.size() > 1)
        log_info("{} = \"{}\" is bound at {}", settings.bind_option, settings.bind,
                 fmt::join(hosts, " and "));
    if (settings.offers_datagrams) bind_datagrams(endpoints, wanted.port == "*");
}

void FrameServer::bind_datagrams(const std::vector<std::string>& endpoints, bool any_port) {
    std::vector<SocketAddress> addresses;
    for (const std::string& bound : endpoints) {
        const Endpoint endpoint = parse_endpoint(bound, "stream.bind");
        addresses.push_back(
            resolve_all(endpoint.host, any_port ? 0 : std::stoi(endpoint.port)).front());
    }
    datagrams_.emplace(addresses, rig_, "stream.road");
    log_info("rig {} offers SRT to hosts at UDP port {}", rig_, datagrams_->port());
}

void FrameServer::serve_datagrams(MonotonicTime now) {
    if (!datagrams_) return;
    std::vector<DatagramServer::Peer> peers;
    {
        const std::lock_guard lock(mutex_);
        peers = links_.datagram_peers();
    }
    const std::vector<DatagramServer::Road> roads = datagrams_->serve(peers, now);
    const std::lock_guard lock(mutex_);
    links_.set_roads(peers, roads);
}

void FrameServer::run() {
    try {
        while (!stopping_) turn();
    } catch (const std::exception& error) {
        log_error("publishing of rig {} ended: {}", rig_, error.what());
        const std::lock_guard lock(mutex_);
        failure_ = error.what();
    }
}

void FrameServer::turn() {
    const MonotonicTime now = MonotonicClock::now();
    if (now >= next_heartbeat_) {
        next_heartbeat_ = now + heartbeat_period;
        beat(now);
    }
    serve_datagrams(now);
    send_all();
    std::vector<zmq::pollitem_t> items{{nullptr, wake_.fd(), ZMQ_POLLIN, 0},
                                       {router_.handle(), 0, ZMQ_POLLIN, 0},
                                       {strangers_.socket().handle(), 0, ZMQ_POLLIN, 0}};
    if (admission_) items.push_back({admission_->socket().handle(), 0, ZMQ_POLLIN, 0});
    std::chrono::nanoseconds wait = next_heartbeat_ - MonotonicClock::now();
    if (waits_for_room_) wait = std::min<std::chrono::nanoseconds>(wait, room_period);
    vantage::wait_for(items, wait);
    wake_.clear();
    if (admission_) admission_->answer();
    strangers_.look(MonotonicClock::now());
    refused_connections_ = strangers_.refused() + (datagrams_ ? datagrams_->refused() : 0);
    for (int i = 0; i < messages_per_turn && receive(); ++i) {
    }
}

void FrameServer::beat(MonotonicTime now) {
    HostLinks::Overrun overrun;
    {
        const std::lock_guard lock(mutex_);
        links_.expire(now);
        links_.ring();
        links_.set_refused_connections(refused_connections_);
        overrun = links_.take_overrun();
    }
    if (overrun.frames > 0) slow_host_ = overrun.host;
    if (const auto frames = overruns_.count(overrun.frames, now))
        log_warning(
            "rig {}: dropped {} frames for newer ones because hosts were too slow; the last was "
            "for {}",
            rig_, *frames, slow_host_);
}

bool FrameServer::receive() {
    std::vector<zmq::message_t> parts;
    if (!zmq::recv_multipart(router_, std::back_inserter(parts), zmq::recv_flags::dontwait))
        return false;
    if (parts.empty()) return true;
    strangers_.hear(parts.back());
    const std::string route = parts.front().to_string();
    const MonotonicTime now = MonotonicClock::now();
    try {
        if (parts.size() != 2) fail("a host message of {} parts came", parts.size() - 1);
        if (is_revoked(route, parts[1])) return true;
        const HostMessage message = decode_host_message(bytes_of(parts[1]));
        note_clock(message, parts[1], now);
        const std::lock_guard lock(mutex_);
        links_.hear(route, host_key_of(parts[1]), message, now);
        if (message.first_pulse != 0) announced_pulse_ = message.first_pulse;
        if (message.fetch || message.report_id != 0) heard_.notify_all();
    } catch (const Error& error) {
        note_refused_input("host message", bytes_of(parts.back()), error.what());
        if (const auto times = complaints_.count(1, now))
            log_warning("messages that are no host's were refused: {}; the last, from {}: {}",
                        *times, address_of(parts.back()), error.what());
        const std::lock_guard lock(mutex_);
        ++malformed_;
        links_.refuse(route, fmt::format("rig {}: {}", rig_, error.what()));
    }
    return true;
}

bool FrameServer::is_revoked(const std::string& route, zmq::message_t& part) {
    if (!admission_) return false;
    const std::string key = host_key_of(part);
    if (admission_->lists(key)) {
        told_.erase(route);
        return false;
    }
    if (!told_.insert(route).second) {
        // It was told why, and speaks on.
        strangers_.disconnect(part);
        told_.erase(route);
        return true;
    }
    const std::lock_guard lock(mutex_);
    links_.dismiss(key);
    log_warning("the host at {} is no longer served: its key {} was removed from {}",
                address_of(part), key, admission_->path().string());
    links_.refuse(route, fmt::format("rig {} no longer admits this host: its key was removed from "
                                     "the rig's authorized_hosts; pair them again, or add the key",
                                     rig_));
    return true;
}

void FrameServer::note_clock(const HostMessage& message, zmq::message_t& part, MonotonicTime now) {
    if (!message.tai_offset_s) return;
    const int own = read_kernel_clock().tai_offset_s;
    if (*message.tai_offset_s == own) return;
    if (clock_complaints_.count(1, now))
        log_warning(
            "the host at {} has a TAI offset from UTC of {} s and this computer {} s, so that "
            "pulses and latencies differ by {} s: set it at the end that has 0 (ptp4l with "
            "phc2sys, or chrony with leapsectz), or at neither",
            address_of(part), *message.tai_offset_s, own, std::abs(*message.tai_offset_s - own));
}

void FrameServer::send_all() {
    std::vector<HostLinks::Outgoing> all;
    {
        const std::lock_guard lock(mutex_);
        all = links_.take();
        waits_for_room_ = links_.waits_for_room();
    }
    std::vector<std::string> gone;
    for (const HostLinks::Outgoing& outgoing : all) {
        // A road of datagrams that has ended does not end the connection over TCP.
        const std::string way = (outgoing.by_datagrams ? "srt" : "tcp") + outgoing.route;
        const bool was_gone = std::find(gone.begin(), gone.end(), way) != gone.end();
        if (!was_gone && send(outgoing)) continue;
        gone.push_back(way);
        const std::lock_guard lock(mutex_);
        links_.undelivered(outgoing);
    }
}

bool FrameServer::send(const HostLinks::Outgoing& outgoing) {
    const std::vector<std::byte> message = encode(outgoing.message);
    if (outgoing.by_datagrams)
        return datagrams_->send(
            outgoing.message.link,
            {message, outgoing.frame->header, outgoing.frame->colour, outgoing.frame->disparity});
    std::vector<std::span<const std::byte>> parts{std::as_bytes(std::span(outgoing.route)),
                                                  message};
    if (outgoing.frame) {
        parts.emplace_back(outgoing.frame->header);
        parts.emplace_back(outgoing.frame->colour);
        parts.emplace_back(outgoing.frame->disparity);
    }
    if (outgoing.report) parts.push_back(std::as_bytes(std::span(*outgoing.report)));
    if (outgoing.kept) {
        parts.emplace_back(outgoing.kept->head);
        parts.emplace_back(outgoing.kept->record);
        parts.emplace_back(outgoing.kept->colour);
        parts.emplace_back(outgoing.kept->depth);
    }
    try {
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const auto more =
                i + 1 < parts.size() ? zmq::send_flags::sndmore : zmq::send_flags::none;
            if (!router_.send(zmq::buffer(parts[i].data(), parts[i].size()),
                              more | zmq::send_flags::dontwait))
                return false;
        }
        return true;
    } catch (const zmq::error_t& error) {
        if (error.num() == EHOSTUNREACH) return false;
        throw;
    }
}

}  // namespace vantage

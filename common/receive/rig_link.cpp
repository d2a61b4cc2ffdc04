#include "common/receive/rig_link.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>
#include <vector>
#include <zmq_addon.hpp>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include "common/base/error.h"
#include "common/base/refused_inputs.h"
#include "common/base/time/kernel_clock.h"
#include "common/config/endpoint.h"
#include "common/receive/credit_window.h"
#include "common/wire/limits.h"
#include "common/wire/random_id.h"
#include "common/wire/zmq_helpers.h"

namespace vantage {
namespace {

/// How often the host retries a refused link, since the rig may have authorized it meanwhile.
constexpr std::chrono::seconds refusal_retry_period{2};
constexpr std::chrono::milliseconds first_reconnect_wait{100};
constexpr std::chrono::milliseconds longest_reconnect_wait{500};
/// Limits a connection attempt: the kernel's own retries become rarer with time.
constexpr std::chrono::milliseconds connect_limit{500};
constexpr int send_high_water_mark = 8;
/// Of a refused message, for bug reports: an offer's passphrase comes behind them.
constexpr std::size_t noted_bytes = 32;
constexpr std::size_t frame_parts = 3, kept_parts = 4;

std::vector<std::byte> copy_of(std::span<const std::byte> bytes) {
    return {bytes.begin(), bytes.end()};
}

/// The frame in the parts behind a RigMessage.
std::shared_ptr<const PackedFrame> frame_of(const std::vector<std::span<const std::byte>>& parts) {
    auto frame = std::make_shared<PackedFrame>();
    frame->header = copy_of(parts[1]);
    frame->colour = copy_of(parts[2]);
    frame->disparity = copy_of(parts[3]);
    return frame;
}

/// Measured by the kernel; 0: unknown.
std::chrono::microseconds round_trip_of(int socket) {
    tcp_info info{};
    socklen_t size = sizeof info;
    if (::getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return {};
    return std::chrono::microseconds(info.tcpi_rtt);
}

}  // namespace

RigLink::RigLink(zmq::context_t& context, const StageConfig::Rig& rig,
                 const std::optional<CurveKeys>& host_keys)
    : context_(context), rig_(rig), host_keys_(host_keys), host_id_(random_id()) {
    const Endpoint endpoint =
        parse_endpoint(rig.endpoint, fmt::format("endpoint of rig {}", rig.name));
    if (endpoint.host == "*" || endpoint.port == "*")
        fail("endpoint of rig {} = \"{}\" has to name one host and one port", rig.name,
             rig.endpoint);
    if (rig.public_key.empty() && !endpoint.loopback)
        fail(
            "rig {} at {} is on another computer, which needs keys: set its public_key and the "
            "stage's key_file",
            rig.name, rig.endpoint);
    if (!rig.public_key.empty() && !is_curve_key(rig.public_key))
        fail(
            "public_key of rig {} is not a CURVE key of 40 characters of Z85; the rig prints it "
            "with: vantage-rig keys show FILE",
            rig.name);
    if (!rig.public_key.empty() && !host_keys)
        fail(
            "rig {} has a public_key, so this host needs a key of its own: set key_file (make one "
            "with: vantage keys new FILE)",
            rig.name);
    address_ = endpoint.text();
    open();
}

RigLink::~RigLink() { close(); }

void RigLink::open() {
    socket_ = zmq::socket_t(context_, zmq::socket_type::dealer);
    socket_.set(zmq::sockopt::linger, 0);
    // Nothing is queued for an absent rig: the request is sent again when it is back.
    socket_.set(zmq::sockopt::immediate, true);
    socket_.set(zmq::sockopt::sndhwm, send_high_water_mark);
    socket_.set(zmq::sockopt::rcvhwm, 2 * static_cast<int>(max_credit_window));
    socket_.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(max_part_bytes));
    socket_.set(zmq::sockopt::reconnect_ivl, option_ms(first_reconnect_wait));
    socket_.set(zmq::sockopt::reconnect_ivl_max, option_ms(longest_reconnect_wait));
    socket_.set(zmq::sockopt::connect_timeout, option_ms(connect_limit));
    watch_for_dead_connections(socket_);
    socket_.set(zmq::sockopt::ipv6, address_.find('[') != std::string::npos);
    if (!rig_.public_key.empty()) {
        socket_.set(zmq::sockopt::curve_serverkey, rig_.public_key);
        socket_.set(zmq::sockopt::curve_publickey, host_keys_->public_key);
        socket_.set(zmq::sockopt::curve_secretkey, host_keys_->secret_key);
    }
    const std::string events = fmt::format("inproc://events-{}", random_id());
    if (zmq_socket_monitor(socket_.handle(), events.c_str(), ZMQ_EVENT_ALL) != 0)
        fail("the link to rig {} cannot be monitored: {}", rig_.name, zmq_strerror(zmq_errno()));
    monitor_ = zmq::socket_t(context_, zmq::socket_type::pair);
    monitor_.set(zmq::sockopt::linger, 0);
    monitor_.connect(events);
    try {
        socket_.connect(address_);
    } catch (const zmq::error_t& error) {
        fail("endpoint of rig {} = \"{}\" cannot be connected to: {}", rig_.name, rig_.endpoint,
             error.what());
    }
}

void RigLink::continue_from(const Continuity& former) {
    host_id_ = former.host_id;
    account_ = former.account;
    show_account();
}

void RigLink::show_account() {
    view_.lost = account_.lost();
    view_.restarts = account_.restarts();
    view_.link = account_.link_counters();
    view_.rig_counters = account_.rig_counters();
}

void RigLink::use_address(const std::string& address) {
    if (address == address_) return;
    address_ = address;
    reopen_.reset();
    close();
    open();
}

void RigLink::close() {
    datagrams_.reset();
    peer_.reset();
    peer_socket_ = -1;
    if (socket_) zmq_socket_monitor(socket_.handle(), nullptr, 0);
    monitor_.close();
    socket_.close();
}

std::optional<RigLink::Delivery> RigLink::receive(MonotonicTime now) {
    // First, so that no frame which has come counts as lost with the end of its road.
    if (std::optional<Delivery> delivery = receive_datagrams(now)) return delivery;
    while (true) {
        std::vector<zmq::message_t> parts;
        if (!zmq::recv_multipart(socket_, std::back_inserter(parts), zmq::recv_flags::dontwait))
            return std::nullopt;
        try {
            Delivery delivery;
            Parts bytes;
            for (const zmq::message_t& part : parts) bytes.push_back(bytes_of(part));
            if (take_in(bytes, now, delivery)) return delivery;
        } catch (const Error& error) {
            const std::span<const std::byte> first = bytes_of(parts.front());
            note_malformed("rig message", first.first(std::min(first.size(), noted_bytes)),
                           error.what());
        }
    }
}

void RigLink::note_malformed(const char* what, std::span<const std::byte> bytes,
                             const std::string& reason) {
    ++view_.malformed;
    view_.last_error = reason;
    note_refused_input(what, bytes, reason);
}

std::optional<RigLink::Delivery> RigLink::receive_datagrams(MonotonicTime now) {
    arrived_.clear();
    if (!datagrams_) return std::nullopt;
    while (const auto message = datagrams_->next()) {
        try {
            const FrameParts parts = split_message(*message, datagrams_->offer().passphrase);
            Delivery delivery;
            if (take_in_datagrams({parts.begin(), parts.end()}, now, delivery)) return delivery;
        } catch (const Error& error) {
            note_malformed("frame by datagrams", *message, error.what());
        }
    }
    const DatagramLink::State state = datagrams_->state();
    if (const std::uint64_t damaged =
            state.damaged - std::exchange(damaged_datagrams_, state.damaged)) {
        view_.malformed += damaged;
        view_.last_error = state.last_fault;
    }
    return std::nullopt;
}

bool RigLink::take_in_datagrams(const Parts& parts, MonotonicTime now, Delivery& delivery) {
    delivery.message = decode_rig_message(parts[0]);
    if (delivery.message.rig != rig_.name || !delivery.message.refusal.empty())
        fail("rig {} sent a frame by datagrams as rig {}", rig_.name, delivery.message.rig);
    account_.hear_datagrams(delivery.message);
    view_.heard = now;
    show_account();
    delivery.arrival = now;
    delivery.arrival_tai = TaiClock::now();
    delivery.frame = frame_of(parts);
    return true;
}

void RigLink::follow_offer(const DatagramOffer& offer) {
    if (datagrams_ && datagrams_->offer().id != offer.id) datagrams_.reset();
    // Only a message without a frame has the passphrase.
    if (datagrams_ || offer.id == 0 || offer.passphrase.empty() || !peer_) return;
    damaged_datagrams_ = 0;
    datagrams_ = std::make_unique<DatagramLink>(*peer_, offer, arrived_);
}

bool RigLink::take_in(const Parts& parts, MonotonicTime now, Delivery& delivery) {
    const bool is_kept = parts.size() == 1 + kept_parts;
    const bool is_report = parts.size() == 2;
    if (parts.size() != 1 && parts.size() != 1 + frame_parts && !is_kept && !is_report)
        fail("rig {} sent a message of {} parts", rig_.name, parts.size());
    RigMessage message = decode_rig_message(parts.front());
    if (message.refusal.empty() && message.rig != rig_.name)
        message.refusal = fmt::format(
            "the rig at {} calls itself {}, but the stage calls it {}; make name and endpoint "
            "agree",
            rig_.endpoint, message.rig, rig_.name);
    if (!message.refusal.empty()) {
        view_.refused = message.refusal;
        view_.refusal_passes = message.refusal_passes;
        gone_ = true;
        return false;
    }
    if (is_kept && (!told_.fetch || !message.fetch || message.fetch->id != told_.fetch->id))
        fail("rig {} sent a frame of its own recording that this host did not request", rig_.name);
    if (is_report && (told_.report_id == 0 || message.report_id != told_.report_id ||
                      parts[1].size() > max_report_bytes))
        fail("rig {} sent a report of {} bytes that this host did not request", rig_.name,
             parts[1].size());
    const bool with_frame = parts.size() == 1 + frame_parts;
    account_.hear(message, with_frame);
    view_.heard = now;
    view_.session = message.session;
    gone_ = false;
    view_.refused.clear();
    show_account();
    view_.since_start = message.rig_counters;
    view_.sync = message.sync;
    view_.health = message.health;
    view_.fetch = message.fetch;
    rigs_trouble_ = message.datagram_trouble;
    follow_offer(message.offer);
    if (is_report)
        view_.report = std::make_shared<const std::string>(
            reinterpret_cast<const char*>(parts[1].data()), parts[1].size());
    if (parts.size() <= 2) return false;
    delivery.message = std::move(message);
    delivery.arrival = now;
    delivery.arrival_tai = TaiClock::now();
    if (is_kept) {
        auto kept = std::make_shared<KeptParts>();
        kept->head = copy_of(parts[1]);
        kept->record = copy_of(parts[2]);
        kept->colour = copy_of(parts[3]);
        kept->depth = copy_of(parts[4]);
        delivery.kept = std::move(kept);
        return true;
    }
    delivery.frame = frame_of(parts);
    return true;
}

void RigLink::watch(MonotonicTime now) {
    while (true) {
        std::vector<zmq::message_t> parts;
        if (!zmq::recv_multipart(monitor_, std::back_inserter(parts), zmq::recv_flags::dontwait))
            return;
        std::uint16_t event = 0;
        std::uint32_t value = 0;
        if (parts.empty() || parts.front().size() != sizeof event + sizeof value) continue;
        std::memcpy(&event, parts.front().data<std::byte>(), sizeof event);
        std::memcpy(&value, parts.front().data<std::byte>() + sizeof event, sizeof value);
        switch (event) {
            case ZMQ_EVENT_CONNECTED:
                peer_socket_ = static_cast<int>(value);
                peer_ = peer_of(peer_socket_);
                round_trip_ = {};
                break;
            case ZMQ_EVENT_DISCONNECTED:
                gone_ = true;
                peer_socket_ = -1;
                if (std::exchange(view_.refusal_passes, false)) view_.refused.clear();
                view_.last_error = fmt::format("the connection to {} broke", rig_.endpoint);
                break;
            case ZMQ_EVENT_HANDSHAKE_SUCCEEDED:
                next_heartbeat_ = now;
                break;
            case ZMQ_EVENT_HANDSHAKE_FAILED_AUTH:
                refuse(fmt::format("rig {} at {} does not admit this host; pair them (vantage-rig "
                                   "pair there, vantage setup here), or add its public key {} to "
                                   "the rig's authorized_hosts",
                                   rig_.name, rig_.endpoint,
                                   host_keys_ ? host_keys_->public_key : "(none)"),
                       now);
                break;
            case ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL:
            case ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL:
                refuse(rig_.public_key.empty()
                           ? fmt::format("rig {} at {} accepts only hosts with keys, or is not a "
                                         "rig; set its public_key and the stage's key_file",
                                         rig_.name, rig_.endpoint)
                           : fmt::format("rig {} at {} does not have the key that the stage states "
                                         "as its public_key; compare with: vantage-rig keys show "
                                         "FILE",
                                         rig_.name, rig_.endpoint),
                       now);
                break;
            default:
                break;
        }
    }
}

void RigLink::refuse(std::string sentence, MonotonicTime now) {
    view_.refused = std::move(sentence);
    view_.refusal_passes = false;
    gone_ = true;
    if (!reopen_) reopen_ = now + refusal_retry_period;
}

void RigLink::tick(const Request& request, MonotonicTime now) {
    if (reopen_ && now >= *reopen_) {
        reopen_.reset();
        close();
        open();
    }
    if (now >= next_heartbeat_ && peer_socket_ >= 0)
        if (const auto newest = round_trip_of(peer_socket_); newest > newest.zero())
            round_trip_ = round_trip_ > newest.zero() ? std::min(round_trip_, newest) : newest;
    const double rate_hz =
        std::max<double>(view_.sync.rate_hz, static_cast<double>(view_.health.published_hz));
    HostMessage message;
    message.host_id = host_id_;
    message.link = account_.link();
    message.handled = account_.handled(request.unhandled);
    const DatagramLink::State road = datagrams_ ? datagrams_->state() : DatagramLink::State();
    message.credit_window = credit_window(round_trip_, rate_hz, road.is_open);
    message.streaming = request.streaming;
    message.rate_divisor = request.rate_divisor;
    message.first_pulse = request.first_pulse;
    message.raw_pairs = request.raw_pairs;
    message.fetch = request.fetch;
    message.report_id = request.report_id;
    if (datagrams_) message.datagrams = {datagrams_->offer().id, road.trouble};
    if (now >= next_heartbeat_) own_tai_offset_s_ = read_kernel_clock().tai_offset_s;
    message.tai_offset_s = own_tai_offset_s_;
    if (now < next_heartbeat_ && message == told_) return;
    // ZeroMQ refuses the message while the rig is absent; the next heartbeat tries again.
    const std::vector<std::byte> bytes = encode(message);
    if (socket_.send(zmq::buffer(bytes), zmq::send_flags::dontwait)) told_ = message;
    next_heartbeat_ = now + heartbeat_period;
}

RigLink::View RigLink::view(MonotonicTime now) const {
    View view = view_;
    if (datagrams_) {
        const DatagramLink::State state = datagrams_->state();
        view.by_datagrams = state.is_open;
        view.datagram_trouble = state.trouble;
    }
    if (view.datagram_trouble.empty() && !view.by_datagrams) view.datagram_trouble = rigs_trouble_;
    view.connected = view_.heard && !gone_ && now - *view_.heard <= liveness_limit;
    return view;
}

}  // namespace vantage

#include "common/datagrams/datagram_link.h"

#include <chrono>
#include <utility>

#include "common/base/error.h"
#include "common/base/this_thread.h"
#include "common/datagrams/srt/srt_socket.h"
#include "common/wire/limits.h"

namespace vantage {
namespace {

/// SRT wakes a waiting reader only when it acknowledges packets, which is every 10 ms.
constexpr std::chrono::milliseconds poll_period{1};
constexpr std::size_t most_messages = max_credit_window;

}  // namespace

DatagramLink::DatagramLink(const SocketAddress& rig, const DatagramOffer& offer,
                           const WakeEvent& arrived)
    : rig_(rig.with_port(offer.port)), offer_(offer), arrived_(arrived) {
    thread_ = std::thread([this] { run(); });
}

DatagramLink::~DatagramLink() {
    stopping_ = true;
    thread_.join();
}

std::optional<std::vector<std::byte>> DatagramLink::next() {
    const std::lock_guard lock(mutex_);
    if (messages_.empty()) return std::nullopt;
    std::vector<std::byte> message = std::move(messages_.front());
    messages_.pop_front();
    if (!messages_.empty()) arrived_.notify();
    return message;
}

DatagramLink::State DatagramLink::state() const {
    const std::lock_guard lock(mutex_);
    return state_;
}

bool DatagramLink::is_full() const {
    const std::lock_guard lock(mutex_);
    return messages_.size() >= most_messages;
}

void DatagramLink::run() {
    name_this_thread("datagrams");
    std::string trouble;
    try {
        socket_ = make_srt_socket();
        connect();
        read();
    } catch (const std::exception& error) {
        trouble = error.what();
    }
    if (socket_ >= 0) srt_close(socket_);
    const std::lock_guard lock(mutex_);
    state_.is_open = false;
    state_.trouble = std::move(trouble);
    arrived_.notify();
}

void DatagramLink::connect() {
    set_srt_option(socket_, SRTO_PASSPHRASE, offer_.passphrase, "passphrase");
    set_srt_option(socket_, SRTO_STREAMID, srt_stream_name(offer_.id), "streamid");
    const bool is_begun =
        srt_connect(socket_, rig_.get(), static_cast<int>(rig_.size)) != SRT_ERROR;
    while (is_begun && !stopping_ && srt_getsockstate(socket_) == SRTS_CONNECTING)
        std::this_thread::sleep_for(poll_period);
    if (stopping_) return;
    if (!is_begun || srt_getsockstate(socket_) != SRTS_CONNECTED)
        fail(
            "SRT cannot connect to UDP port {} ({}): open it in the firewalls on the way, or set "
            "road = \"tcp\" in [stream] of the rig",
            rig_.text(), srt_rejectreason_str(srt_getrejectreason(socket_)));
    const std::lock_guard lock(mutex_);
    state_.is_open = true;
    arrived_.notify();
}

void DatagramLink::read() {
    std::vector<char> packet(SRT_LIVE_MAX_PLSIZE);
    while (!stopping_) {
        const int bytes =
            is_full() ? 0 : srt_recvmsg(socket_, packet.data(), static_cast<int>(packet.size()));
        if (bytes > 0) {
            take(std::as_bytes(std::span(packet)).first(static_cast<std::size_t>(bytes)));
            continue;
        }
        if (srt_getsockstate(socket_) != SRTS_CONNECTED)
            fail("the connection over SRT to UDP port {} broke", rig_.text());
        std::this_thread::sleep_for(poll_period);
    }
}

void DatagramLink::take(std::span<const std::byte> packet) {
    try {
        std::optional<std::vector<std::byte>> message = joiner_.take(packet);
        if (!message) return;
        const std::lock_guard lock(mutex_);
        messages_.push_back(std::move(*message));
        arrived_.notify();
    } catch (const Error& error) {
        const std::lock_guard lock(mutex_);
        ++state_.damaged;
        state_.last_fault = error.what();
    }
}

}  // namespace vantage

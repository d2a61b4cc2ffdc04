#include "tests/faults/srt_stream.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <mutex>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <srt/srt.h>

#include "common/base/error.h"
#include "common/wire/limits.h"

namespace vantage {
namespace {

constexpr const char* passphrase = "a passphrase of a measurement";
constexpr std::size_t packet_bytes = 1316;
/// Frames of which the receiver keeps packets.
constexpr std::size_t most_partial = 16;
/// As many as a rig allows a host at most.
constexpr std::size_t most_frames_under_way = max_credit_window;
constexpr std::size_t largest_packet = 1500, largest_message = 8 << 20;
/// SRT wakes a waiting reader only when it acknowledges packets, which is every 10 ms.
constexpr std::chrono::microseconds poll_period{500};

/// Stands before the bytes of each packet.
struct PacketHead {
    std::uint32_t frame = 0, packet = 0, packets = 0, frame_bytes = 0;
};
constexpr std::size_t content_bytes = packet_bytes - sizeof(PacketHead);

void start_srt() {
    static std::once_flag once;
    std::call_once(once, [] {
        srt_startup();
        srt_setloglevel(LOG_CRIT);
    });
}

void set(int socket, SRT_SOCKOPT option, const auto& value, const char* name) {
    if (srt_setsockflag(socket, option, &value, sizeof value) != 0)
        fail("SRT's option {} cannot be set: {}", name, srt_getlasterror_str());
}

void set_text(int socket, SRT_SOCKOPT option, const std::string& value, const char* name) {
    if (srt_setsockflag(socket, option, value.data(), static_cast<int>(value.size())) != 0)
        fail("SRT's option {} cannot be set: {}", name, srt_getlasterror_str());
}

int socket_of(const SrtManner& manner) {
    start_srt();
    const int socket = srt_create_socket();
    if (socket == SRT_INVALID_SOCK) fail("no SRT socket: {}", srt_getlasterror_str());
    const SRT_TRANSTYPE type = manner.sends_messages ? SRTT_FILE : SRTT_LIVE;
    set(socket, SRTO_TRANSTYPE, type, "transtype");
    set(socket, SRTO_MESSAGEAPI, true, "messageapi");
    set_text(socket, SRTO_PASSPHRASE, passphrase, "passphrase");
    set(socket, SRTO_PBKEYLEN, 16, "pbkeylen");
    if (!manner.sends_messages) {
        set(socket, SRTO_TSBPDMODE, manner.hold_ms > 0, "tsbpdmode");
        set(socket, SRTO_TLPKTDROP, manner.hold_ms > 0, "tlpktdrop");
        if (manner.hold_ms > 0) set(socket, SRTO_LATENCY, manner.hold_ms, "latency");
        set(socket, SRTO_MAXBW, manner.most_bytes_per_s, "maxbw");
        if (!manner.filter.empty())
            set_text(socket, SRTO_PACKETFILTER, manner.filter, "packetfilter");
    }
    return socket;
}

sockaddr_in address_of(const std::string& host, int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    ::inet_pton(AF_INET, host.c_str(), &address.sin_addr);
    return address;
}

}  // namespace

SrtSender::SrtSender(const SrtManner& manner, int port)
    : manner_(manner), listener_(socket_of(manner)) {
    const sockaddr_in address = address_of("0.0.0.0", port);
    if (srt_bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        srt_listen(listener_, 1) != 0)
        fail("SRT cannot listen at port {}: {}", port, srt_getlasterror_str());
}

SrtSender::~SrtSender() {
    if (socket_ >= 0) srt_close(socket_);
    srt_close(listener_);
}

void SrtSender::accept() {
    socket_ = srt_accept(listener_, nullptr, nullptr);
    if (socket_ == SRT_INVALID_SOCK) fail("no SRT receiver came: {}", srt_getlasterror_str());
    set(socket_, SRTO_SNDSYN, false, "sndsyn");
}

void SrtSender::send(std::span<const std::byte> frame) {
    std::size_t blocks = 0, waiting_bytes = 0;
    srt_getsndbuffer(socket_, &blocks, &waiting_bytes);
    if (waiting_bytes > most_frames_under_way * frame.size()) return;
    // Without an age at which SRT gives up: libsrt 1.5.1 then leaves holes in the receiver's
    // buffer that it never closes, until the buffer is full.
    constexpr int never = -1;
    const auto send = [&](const void* bytes, std::size_t count) {
        constexpr int in_order = 1;
        return srt_sendmsg(socket_, static_cast<const char*>(bytes), static_cast<int>(count), never,
                           in_order) != SRT_ERROR;
    };
    if (manner_.sends_messages) {
        (void)send(frame.data(), frame.size());
        return;
    }
    PacketHead head{
        .frame = frames_++,
        .packets = static_cast<std::uint32_t>((frame.size() + content_bytes - 1) / content_bytes),
        .frame_bytes = static_cast<std::uint32_t>(frame.size())};
    std::array<char, packet_bytes> packet;
    for (; head.packet < head.packets; ++head.packet) {
        const std::span<const std::byte> rest = frame.subspan(head.packet * content_bytes);
        const std::span<const std::byte> part = rest.first(std::min(content_bytes, rest.size()));
        std::memcpy(packet.data(), &head, sizeof head);
        std::memcpy(packet.data() + sizeof head, part.data(), part.size());
        if (!send(packet.data(), sizeof head + part.size())) return;
    }
}

SrtReceiver::SrtReceiver(const SrtManner& manner, const std::string& address, int port,
                         std::function<void(std::span<const std::byte>)> take)
    : manner_(manner), socket_(socket_of(manner)), take_(std::move(take)) {
    const sockaddr_in to = address_of(address, port);
    if (srt_connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == SRT_ERROR)
        fail("SRT cannot connect to {}:{}: {}", address, port, srt_getlasterror_str());
    set(socket_, SRTO_RCVSYN, false, "rcvsyn");
    thread_ = std::thread([this] { run(); });
}

SrtReceiver::~SrtReceiver() {
    stopping_ = true;
    thread_.join();
    srt_close(socket_);
}

void SrtReceiver::run() {
    std::vector<char> message(manner_.sends_messages ? largest_message : largest_packet);
    while (!stopping_) {
        const int bytes = srt_recvmsg(socket_, message.data(), static_cast<int>(message.size()));
        if (bytes <= 0) {
            if (srt_getsockstate(socket_) != SRTS_CONNECTED) return;
            std::this_thread::sleep_for(poll_period);
            continue;
        }
        const auto content =
            std::as_bytes(std::span(message)).first(static_cast<std::size_t>(bytes));
        if (manner_.sends_messages)
            take_(content);
        else
            take_packet(content);
    }
}

void SrtReceiver::take_packet(std::span<const std::byte> packet) {
    PacketHead head;
    if (packet.size() < sizeof head) return;
    std::memcpy(&head, packet.data(), sizeof head);
    const std::span<const std::byte> content = packet.subspan(sizeof head);
    auto partial = std::find_if(partial_.begin(), partial_.end(),
                                [&](const Partial& one) { return one.frame == head.frame; });
    if (partial == partial_.end()) {
        if (partial_.size() == most_partial) partial_.erase(partial_.begin());
        partial = partial_.insert(partial_.end(), {head.frame, head.packets, {}, {}});
        partial->bytes.resize(head.frame_bytes);
        partial->has.resize(head.packets);
    }
    if (head.packet >= partial->has.size() || partial->has[head.packet] ||
        head.packet * content_bytes + content.size() > partial->bytes.size())
        return;
    partial->has[head.packet] = true;
    std::copy(content.begin(), content.end(),
              partial->bytes.begin() + static_cast<std::ptrdiff_t>(head.packet * content_bytes));
    if (--partial->missing > 0) return;
    take_(partial->bytes);
    partial_.erase(partial);
}

}  // namespace vantage

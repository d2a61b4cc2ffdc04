#include "common/datagrams/srt/srt_socket.h"

#include <cstdint>
#include <mutex>

#include <fmt/format.h>

#include "common/base/error.h"
#include "common/base/library_log.h"

namespace vantage {
namespace {

/// The most that a rig sends a host; also the rate at which a frame's packets leave, so that they
/// do not overrun a switch: a frame of 200 kB takes 5 ms.
constexpr std::int64_t most_bytes_per_s = 40'000'000;
/// A further packet for each five (docs/results/faults.md). With arq:onreq, the default, libsrt
/// 1.5.1 stops for good where packets are not held back and the correction cannot compute one.
constexpr const char* error_correction = "fec,cols:5,arq:always";
/// Without packets of the other end for this long a connection is broken.
constexpr int idle_limit_ms = 3000;
constexpr int connect_limit_ms = 3000;
/// AES-128.
constexpr int key_bytes = 16;
/// SRT's buffers count every packet as the largest one: an Ethernet frame of 1500 bytes without the
/// headers of IP and UDP.
constexpr int buffer_bytes_a_packet = 1472;

/// SRT is never ended: FFmpeg's outputs use the same library.
void start_srt() {
    static std::once_flag once;
    std::call_once(once, [] {
        srt_startup();
        srt_setlogflags(SRT_LOGF_DISABLE_TIME | SRT_LOGF_DISABLE_THREADNAME |
                        SRT_LOGF_DISABLE_SEVERITY | SRT_LOGF_DISABLE_EOL);
        srt_setloghandler(nullptr, keep_srt_message);
    });
}

}  // namespace

void set_srt_option(int socket, SRT_SOCKOPT option, const void* value, std::size_t bytes,
                    const char* name) {
    if (srt_setsockflag(socket, option, value, static_cast<int>(bytes)) != 0)
        fail("SRT's option {} cannot be set: {}", name, srt_getlasterror_str());
}

void set_srt_option(int socket, SRT_SOCKOPT option, const std::string& value, const char* name) {
    set_srt_option(socket, option, value.data(), value.size(), name);
}

int make_srt_socket() {
    start_srt();
    const int socket = srt_create_socket();
    if (socket == SRT_INVALID_SOCK) fail("SRT has no socket: {}", srt_getlasterror_str());
    const auto set = [&](SRT_SOCKOPT option, const auto& value, const char* name) {
        set_srt_option(socket, option, &value, sizeof value, name);
    };
    try {
        constexpr bool no = false;
        set(SRTO_TRANSTYPE, SRTT_LIVE, "transtype");
        set(SRTO_TSBPDMODE, no, "tsbpdmode");
        set(SRTO_TLPKTDROP, no, "tlpktdrop");
        set(SRTO_RCVSYN, no, "rcvsyn");
        set(SRTO_SNDSYN, no, "sndsyn");
        set(SRTO_REUSEADDR, no, "reuseaddr");
        set(SRTO_MAXBW, most_bytes_per_s, "maxbw");
        set(SRTO_PBKEYLEN, key_bytes, "pbkeylen");
        set(SRTO_PEERIDLETIMEO, idle_limit_ms, "peeridletimeo");
        set(SRTO_CONNTIMEO, connect_limit_ms, "conntimeo");
        constexpr int buffer_bytes = static_cast<int>(srt_buffer_packets) * buffer_bytes_a_packet;
        set(SRTO_SNDBUF, buffer_bytes, "sndbuf");
        set(SRTO_RCVBUF, buffer_bytes, "rcvbuf");
        set_srt_option(socket, SRTO_PACKETFILTER, error_correction, "packetfilter");
    } catch (...) {
        srt_close(socket);
        throw;
    }
    return socket;
}

std::string srt_stream_name(std::uint64_t offer) { return fmt::format("{:016x}", offer); }

SocketAddress bound_srt_address(int socket) {
    SocketAddress address;
    int size = sizeof address.bytes;
    if (srt_getsockname(socket, reinterpret_cast<sockaddr*>(&address.bytes), &size) != 0)
        fail("SRT does not say which address it has bound: {}", srt_getlasterror_str());
    address.size = static_cast<socklen_t>(size);
    return address;
}

}  // namespace vantage

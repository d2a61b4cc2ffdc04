#pragma once

#include <cstddef>
#include <string>

#include <srt/srt.h>

#include "common/config/socket_address.h"

namespace vantage {

// SRT's sockets as both ends of a road of datagrams need them.

/// Packets that wait at the sender or at the receiver at most.
inline constexpr std::size_t srt_buffer_packets = 12000;

/// A socket that never blocks, with forward error correction and without holding packets back.
/// Throws Error.
int make_srt_socket();

/// Throws Error, naming the option.
void set_srt_option(int socket, SRT_SOCKOPT option, const void* value, std::size_t bytes,
                    const char* name);
void set_srt_option(int socket, SRT_SOCKOPT option, const std::string& value, const char* name);

/// The name of an offer in SRT's handshake, which everybody on the way can read.
std::string srt_stream_name(std::uint64_t offer);

/// The address that a socket is bound to.
SocketAddress bound_srt_address(int socket);

}  // namespace vantage

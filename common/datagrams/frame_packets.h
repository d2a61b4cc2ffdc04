#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace vantage {

// A frame on the road of datagrams: the RigMessage and the three parts of a PackedFrame, each
// behind its size, and a seal (BLAKE2b with the offer's passphrase as key), cut into packets.

inline constexpr std::size_t frame_message_parts = 4;
using FrameParts = std::array<std::span<const std::byte>, frame_message_parts>;

/// The payload of a packet, which fits in every usual network's packets with SRT's own headers.
inline constexpr std::size_t packet_bytes = 1316;

/// The largest frame message. Larger frames go over TCP.
inline constexpr std::size_t max_datagram_message_bytes = std::size_t{8} << 20;

/// The size of the message that join_parts() makes of so many bytes.
std::size_t message_bytes_of(std::size_t bytes_of_parts);
/// Number of packets that a message of so many bytes is cut into.
std::size_t packets_of(std::size_t message_bytes);

/// Joins the parts to one sealed message. Precondition: message_bytes_of() is at most
/// max_datagram_message_bytes.
std::vector<std::byte> join_parts(const FrameParts& parts, std::string_view passphrase);

/// Returns the parts of a message, as views of it. Throws Error if its seal was not made with this
/// passphrase or its sizes contradict each other.
FrameParts split_message(std::span<const std::byte> message, std::string_view passphrase);

/// Cuts a message into packets and calls `send` with each of them in order, until it returns false.
/// `number` tells the message from the ones before it. Returns whether all packets were sent.
bool cut_message(std::span<const std::byte> message, std::uint32_t number,
                 const std::function<bool(std::span<const std::byte>)>& send);

/// Joins packets to messages. Packets come in order; a message that lacks one is given up. Keeps
/// one message, which grows with the bytes that come. Takes untrusted bytes. Not thread-safe.
class FrameJoiner {
  public:
    /// Takes a packet in. Returns the message that it completes. Throws Error for a packet that is
    /// none of a message, or not the next one, and gives up the message that was begun.
    std::optional<std::vector<std::byte>> take(std::span<const std::byte> packet);

  private:
    std::uint32_t number_ = 0;
    std::uint32_t next_ = 0;     ///< packet that comes next; 0: the first one of a message
    std::uint32_t packets_ = 0;  ///< of the message
    std::vector<std::byte> message_;
};

}  // namespace vantage

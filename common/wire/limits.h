#pragma once

#include <cstddef>
#include <cstdint>

namespace vantage {

// The limits of messages for both ends of the wire protocol. A message beyond a limit is refused
// before memory is allocated for it.

/// The version of frame.proto and link.proto; an end with another version is refused.
inline constexpr std::uint32_t wire_schema_version = 2;

/// The largest side of an image: the limit of a Raspberry Pi's GPU.
inline constexpr int max_picture_side_px = 4096;

/// The size of a serialised FrameHeader, RigMessage or HostMessage.
inline constexpr std::size_t max_header_bytes = 4096;

/// The size of a rig's report for a bug report (JSON).
inline constexpr std::size_t max_report_bytes = std::size_t{1} << 20;

/// By how much a compressed payload may exceed its uncompressed image.
inline constexpr std::size_t payload_slack_bytes = 64 * 1024;

/// The largest message part: an incompressible image of the largest size.
inline constexpr std::size_t max_part_bytes =
    std::size_t{4} * max_picture_side_px * max_picture_side_px + payload_slack_bytes;

/// The length of rig names and calibration ids.
inline constexpr std::size_t max_name_chars = 64;

/// The largest magnitude of a number that a rig reports about itself. A clock that was never set is
/// 1.8e18 ns behind.
inline constexpr double max_measurement = 1e19;

/// Up to this value an index is exact as a double, and index times period cannot overflow.
inline constexpr std::uint64_t max_trigger_index = std::uint64_t{1} << 53;

/// The number of frames on the way to one host, whatever credit it gives.
inline constexpr std::uint32_t max_credit_window = 16;
/// The same while frames go by datagrams, whose sender also bounds what is not acknowledged. Their
/// credit goes over TCP, which may stand still for a second where packets get lost.
inline constexpr std::uint32_t max_datagram_credit_window = 64;

inline constexpr std::uint32_t max_rate_divisor = 1000;

}  // namespace vantage

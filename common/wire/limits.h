#pragma once

#include <cstddef>
#include <cstdint>

namespace vantage {

// What either end of the wire accepts. A message beyond any of these is refused before memory is
// taken for it.

/// Version of frame.proto and link.proto; an end that speaks another one is refused with a
/// sentence.
inline constexpr std::uint32_t wire_schema_version = 2;

/// Largest picture side: the largest image a Raspberry Pi's GPU holds.
inline constexpr int max_picture_side_px = 4096;

/// Serialised FrameHeader, RigMessage or HostMessage.
inline constexpr std::size_t max_header_bytes = 4096;

/// What a rig says of itself for help, as JSON.
inline constexpr std::size_t max_report_bytes = std::size_t{1} << 20;

/// A compressed payload may be this much larger than the picture it holds, and no more.
inline constexpr std::size_t payload_slack_bytes = 64 * 1024;

/// Largest part of any message: a picture of the largest size that does not compress at all.
inline constexpr std::size_t max_part_bytes =
    std::size_t{4} * max_picture_side_px * max_picture_side_px + payload_slack_bytes;

/// Rig names, calibration ids.
inline constexpr std::size_t max_name_chars = 64;

/// Up to here an index is exact as a double, and index times period is far from overflow.
inline constexpr std::uint64_t max_trigger_index = std::uint64_t{1} << 53;

/// Frames that may be under way to one host, whatever credit it gives.
inline constexpr std::uint32_t max_credit_window = 16;

inline constexpr std::uint32_t max_rate_divisor = 1000;

}  // namespace vantage

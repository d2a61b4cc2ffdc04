#pragma once

namespace vantage {

/// Where a rig listens while it is open for pairing, unless it is told another port.
inline constexpr int pairing_port = 5590;

// What rigs announce by DNS-SD (RFC 6763), under their own names.

/// A rig that is open for pairing, at its pairing port.
inline constexpr const char* pairing_service = "_vantage-pair._tcp";
/// A rig that streams to other computers, at its stream's port.
inline constexpr const char* stream_service = "_vantage._tcp";

}  // namespace vantage

#pragma once

namespace vantage {

/// The port on which a rig listens while it is open for pairing, unless another is configured.
inline constexpr int pairing_port = 5590;

// DNS-SD service types (RFC 6763) that rigs announce under their own names.

/// A rig that is open for pairing, at its pairing port.
inline constexpr const char* pairing_service = "_vantage-pair._tcp";
/// A rig that streams to other computers, at its stream port.
inline constexpr const char* stream_service = "_vantage._tcp";

}  // namespace vantage

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "common/wire/frame_message.h"

namespace google::protobuf {
class MessageLite;
}

namespace vantage {

namespace wire {
class Counters;
class Sync;
}  // namespace wire

// Parts shared by all messages of the wire protocol.

/// Throws Error unless it is this program's schema version.
void check_schema_version(std::string_view what, std::uint32_t version);

/// Throws Error unless the name is 1..max_name_chars letters, digits, '-', '_', '.'.
void check_name(std::string_view what, std::string_view name);

/// Throws Error unless a number that a rig reports in `where` is finite and within max_measurement.
void check_measurement(std::string_view where, double value);

/// Silences protobuf's own log; its reasons are in the Error of a damaged message.
void keep_protobuf_quiet();

std::vector<std::byte> serialise(const google::protobuf::MessageLite& message);

/// Throws Error for a part beyond max_header_bytes or bytes that are not such a message.
void parse(std::span<const std::byte> part, std::string_view what,
           google::protobuf::MessageLite& message);

void to_wire(const RigCounters& counters, wire::Counters& out);
RigCounters from_wire(const wire::Counters& counters);

void to_wire(const RigSync& sync, wire::Sync& out);
/// Throws Error for values that are not finite or too large, and for a state with control
/// characters.
RigSync from_wire(const wire::Sync& sync);

}  // namespace vantage

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

// What all messages of the wire have in common.

/// Throws Error unless it is the version that this program speaks.
void check_schema_version(std::string_view what, std::uint32_t version);

/// Throws Error unless the name is 1..max_name_chars letters, digits, '-', '_', '.'.
void check_name(std::string_view what, std::string_view name);

/// What the library would print of a damaged message is in the Error that the message ends in.
void keep_protobuf_quiet();

std::vector<std::byte> serialise(const google::protobuf::MessageLite& message);

/// Throws Error for parts beyond max_header_bytes and for bytes that are no such message.
void parse(std::span<const std::byte> part, std::string_view what,
           google::protobuf::MessageLite& message);

void to_wire(const RigCounters& counters, wire::Counters& out);
RigCounters from_wire(const wire::Counters& counters);

void to_wire(const RigSync& sync, wire::Sync& out);
/// Throws Error for numbers that are none and a state that is no word.
RigSync from_wire(const wire::Sync& sync);

}  // namespace vantage

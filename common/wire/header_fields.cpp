#include "common/wire/header_fields.h"

#include <algorithm>
#include <cassert>

#include "common/base/error.h"
#include "common/wire/limits.h"
#include "frame.pb.h"

namespace vantage {

void check_schema_version(std::string_view what, std::uint32_t version) {
    if (version != wire_schema_version)
        fail(
            "a {} of schema version {} came where this program speaks version {}; install the same "
            "version of Vantage on rigs and host",
            what, version, wire_schema_version);
}

void check_name(std::string_view what, std::string_view name) {
    const bool fits = !name.empty() && name.size() <= max_name_chars &&
                      std::all_of(name.begin(), name.end(), [](char c) {
                          return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                                 (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
                      });
    if (!fits)
        fail("a {} name has to be 1..{} letters, digits, '-', '_' or '.'", what, max_name_chars);
}

std::vector<std::byte> serialise(const google::protobuf::MessageLite& message) {
    std::vector<std::byte> bytes(message.ByteSizeLong());
    [[maybe_unused]] const bool whole =
        message.SerializeToArray(bytes.data(), static_cast<int>(bytes.size()));
    assert(whole && bytes.size() <= max_header_bytes);
    return bytes;
}

void parse(std::span<const std::byte> part, std::string_view what,
           google::protobuf::MessageLite& message) {
    if (part.size() > max_header_bytes)
        fail("a {} of {} bytes is beyond the limit of {}", what, part.size(), max_header_bytes);
    if (!message.ParseFromArray(part.data(), static_cast<int>(part.size())))
        fail("a {} of {} bytes is truncated or damaged", what, part.size());
}

void to_wire(const RigCounters& counters, wire::Counters& out) {
    out.set_captured(counters.captured);
    out.set_missed(counters.missed);
    out.set_late(counters.late);
    out.set_published(counters.published);
    out.set_send_dropped(counters.send_dropped);
}

RigCounters from_wire(const wire::Counters& counters) {
    return {counters.captured(), counters.missed(), counters.late(), counters.published(),
            counters.send_dropped()};
}

}  // namespace vantage

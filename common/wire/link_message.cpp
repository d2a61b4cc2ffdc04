#include "common/wire/link_message.h"

#include "common/base/error.h"
#include "common/wire/header_fields.h"
#include "common/wire/limits.h"
#include "link.pb.h"

namespace vantage {
namespace {

constexpr std::size_t max_refusal_chars = 512;

}  // namespace

std::vector<std::byte> encode(const HostMessage& message) {
    wire::HostMessage out;
    out.set_schema_version(wire_schema_version);
    out.set_host_id(message.host_id);
    out.set_link(message.link);
    out.set_handled(message.handled);
    out.set_credit_window(message.credit_window);
    out.set_streaming(message.streaming);
    out.set_rate_divisor(message.rate_divisor);
    out.set_first_pulse(message.first_pulse);
    return serialise(out);
}

HostMessage decode_host_message(std::span<const std::byte> part) {
    wire::HostMessage in;
    parse(part, "host message", in);
    check_schema_version("host message", in.schema_version());
    if (in.host_id() == 0) fail("a host message without host id came");
    if (in.credit_window() < 1 || in.credit_window() > max_credit_window)
        fail("a credit window of {} frames is outside 1..{}", in.credit_window(),
             max_credit_window);
    if (in.rate_divisor() < 1 || in.rate_divisor() > max_rate_divisor)
        fail("a rate divisor of {} is outside 1..{}", in.rate_divisor(), max_rate_divisor);
    if (in.first_pulse() > max_trigger_index)
        fail("a first pulse of {} is beyond {}", in.first_pulse(), max_trigger_index);
    return {in.host_id(),   in.link(),         in.handled(),    in.credit_window(),
            in.streaming(), in.rate_divisor(), in.first_pulse()};
}

std::vector<std::byte> encode(const RigMessage& message) {
    wire::RigMessage out;
    out.set_schema_version(wire_schema_version);
    out.set_rig(message.rig);
    out.set_session(message.session);
    out.set_link(message.link);
    out.set_offered(message.counters.offered);
    out.set_sent(message.counters.sent);
    out.set_send_dropped(message.counters.send_dropped);
    out.set_thinned(message.counters.thinned);
    to_wire(message.rig_counters, *out.mutable_counters());
    to_wire(message.sync, *out.mutable_sync());
    out.set_refusal(message.refusal.substr(0, max_refusal_chars));
    return serialise(out);
}

RigMessage decode_rig_message(std::span<const std::byte> part) {
    wire::RigMessage in;
    parse(part, "rig message", in);
    check_schema_version("rig message", in.schema_version());
    check_name("rig", in.rig());
    if (in.refusal().size() > max_refusal_chars)
        fail("a refusal of {} characters is beyond the limit of {}", in.refusal().size(),
             max_refusal_chars);
    for (const char c : in.refusal())
        if (static_cast<unsigned char>(c) < ' ') fail("a refusal with control characters came");
    if (in.refusal().empty() && in.link() == 0) fail("a rig message without link came");
    RigMessage message;
    message.rig = in.rig();
    message.session = in.session();
    message.link = in.link();
    message.counters = {in.offered(), in.sent(), in.send_dropped(), in.thinned()};
    message.rig_counters = from_wire(in.counters());
    message.sync = from_wire(in.sync());
    message.refusal = in.refusal();
    return message;
}

}  // namespace vantage

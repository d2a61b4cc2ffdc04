#include "common/wire/header_fields.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <google/protobuf/stubs/logging.h>

#include "common/base/error.h"
#include "common/wire/limits.h"
#include "frame.pb.h"

namespace vantage {
void keep_protobuf_quiet() {
    [[maybe_unused]] static const auto replaced = google::protobuf::SetLogHandler(nullptr);
}

void check_schema_version(std::string_view what, std::uint32_t version) {
    if (version != wire_schema_version)
        fail(
            "a {} of schema version {} came where this program speaks version {}; install the same "
            "version of Vantage on rigs and host",
            what, version, wire_schema_version);
}

void check_measurement(std::string_view where, double value) {
    if (!std::isfinite(value)) fail("a rig's {} holds {}, which is not finite", where, value);
    if (std::abs(value) > max_measurement)
        fail("a rig's {} holds {}, which is beyond the limit of {:g}", where, value,
             max_measurement);
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
    keep_protobuf_quiet();
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

void to_wire(const RigSync& sync, wire::Sync& out) {
    out.set_role(static_cast<wire::Sync::Role>(sync.role));
    out.set_ready(sync.ready);
    out.set_first_pulse(sync.first_pulse);
    out.set_pulses(sync.pulses);
    out.set_skipped(sync.skipped);
    out.set_unsynchronized(sync.unsynchronized);
    out.set_lateness_p50_us(sync.lateness_p50_us);
    out.set_lateness_p99_us(sync.lateness_p99_us);
    out.set_lateness_max_us(sync.lateness_max_us);
    out.set_clock_ppm(sync.clock_ppm);
    out.set_clock_steps(sync.clock_steps);
    out.set_clock_step_ms(sync.clock_step_ms);
    out.set_disciplined(sync.disciplined);
    out.set_ptp_offset_ns(sync.ptp_offset_ns);
    out.set_ptp_path_delay_ns(sync.ptp_path_delay_ns);
    out.set_ptp_state(sync.ptp_state);
    out.set_tai_offset_s(sync.tai_offset_s);
    out.set_rate_hz(sync.rate_hz);
}

RigSync from_wire(const wire::Sync& sync) {
    for (const double value :
         {static_cast<double>(sync.lateness_p50_us()), static_cast<double>(sync.lateness_p99_us()),
          static_cast<double>(sync.lateness_max_us()), sync.clock_ppm(), sync.clock_step_ms(),
          sync.ptp_offset_ns(), sync.ptp_path_delay_ns(), sync.rate_hz()})
        check_measurement("sync state", value);
    // The range of PulseGrid.
    if (sync.rate_hz() != 0 && (sync.rate_hz() < 0.001 || sync.rate_hz() > 1e6))
        fail("a rig's rate of {} Hz is outside 0.001..1000000", sync.rate_hz());
    if (sync.role() < wire::Sync::FREE || sync.role() > wire::Sync::FOLLOW)
        fail("a rig's sync state has the unknown role {}", static_cast<int>(sync.role()));
    if (sync.first_pulse() > max_trigger_index)
        fail("a first pulse of {} is beyond {}", sync.first_pulse(), max_trigger_index);
    if (!sync.ptp_state().empty()) check_name("PTP state", sync.ptp_state());
    RigSync result;
    result.role = static_cast<RigSync::Role>(sync.role());
    result.ready = sync.ready();
    result.first_pulse = sync.first_pulse();
    result.pulses = sync.pulses();
    result.skipped = sync.skipped();
    result.unsynchronized = sync.unsynchronized();
    result.lateness_p50_us = sync.lateness_p50_us();
    result.lateness_p99_us = sync.lateness_p99_us();
    result.lateness_max_us = sync.lateness_max_us();
    result.clock_ppm = sync.clock_ppm();
    result.clock_steps = sync.clock_steps();
    result.clock_step_ms = sync.clock_step_ms();
    result.disciplined = sync.disciplined();
    result.ptp_offset_ns = sync.ptp_offset_ns();
    result.ptp_path_delay_ns = sync.ptp_path_delay_ns();
    result.ptp_state = sync.ptp_state();
    result.tai_offset_s = sync.tai_offset_s();
    result.rate_hz = sync.rate_hz();
    return result;
}

}  // namespace vantage

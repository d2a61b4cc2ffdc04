#include "common/wire/link_message.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "common/base/error.h"
#include "common/wire/header_fields.h"
#include "common/wire/limits.h"
#include "link.pb.h"

namespace vantage {
namespace {

void check_printable(std::string_view what, std::string_view text) {
    for (const char c : text)
        if (static_cast<unsigned char>(c) < ' ') fail("a {} with control characters came", what);
}

/// The length of a refusal, and of a fetch's trouble.
constexpr std::size_t max_refusal_chars = 512;
constexpr std::size_t max_date_chars = 40, max_version_chars = 40, max_starting_chars = 120,
                      max_keeps_chars = 512;

void to_wire(const RigHealth& health, wire::Health& out) {
    if (health.temperature_c) out.set_temperature_c(*health.temperature_c);
    out.set_under_voltage(health.under_voltage);
    out.set_captured_hz(health.captured_hz);
    out.set_published_hz(health.published_hz);
    out.set_calibration_id(health.calibration_id);
    out.set_calibration_date(health.calibration_date.substr(0, max_date_chars));
    out.set_calibration_row_rms_px(health.calibration_row_rms_px);
    out.set_program_version(health.program_version.substr(0, max_version_chars));
    out.set_refused_connections(health.refused_connections);
    out.set_starting(health.starting.substr(0, max_starting_chars));
    std::string keeps = health.keeps.substr(0, max_keeps_chars);
    // A folder's name may hold control characters, or UTF-8 that the cut splits.
    constexpr char first_printable = ' ', del = 0x7f;
    std::replace_if(
        keeps.begin(), keeps.end(), [](char c) { return c < first_printable || c == del; }, '?');
    out.set_keeps(keeps);
}

void check_sentence(std::string_view what, std::string_view text) {
    if (text.size() > max_refusal_chars)
        fail("a {} of {} characters is beyond the limit of {}", what, text.size(),
             max_refusal_chars);
    check_printable(what, text);
}

DatagramOffer from_wire(const wire::DatagramOffer& in) {
    constexpr std::uint32_t max_port = 65535;
    // SRT's limits.
    constexpr std::size_t min_passphrase_chars = 10, max_passphrase_chars = 79;
    if (in.id() == 0) fail("an offer of datagrams without an id came");
    if (in.port() < 1 || in.port() > max_port)
        fail("an offer of datagrams at port {} is outside 1..{}", in.port(), max_port);
    const std::string& passphrase = in.passphrase();
    if (!passphrase.empty() &&
        (passphrase.size() < min_passphrase_chars || passphrase.size() > max_passphrase_chars))
        fail("a passphrase of {} characters is outside {}..{}", passphrase.size(),
             min_passphrase_chars, max_passphrase_chars);
    check_printable("passphrase", passphrase);
    return {in.id(), static_cast<std::uint16_t>(in.port()), passphrase};
}

RigHealth from_wire(const wire::Health& in) {
    for (const float value :
         {in.temperature_c(), in.captured_hz(), in.published_hz(), in.calibration_row_rms_px()})
        check_measurement("health", value);
    if (!in.calibration_id().empty()) check_name("calibration", in.calibration_id());
    const std::string& date = in.calibration_date();
    if (date.size() > max_date_chars)
        fail("a calibration date of {} characters is beyond the limit of {}", date.size(),
             max_date_chars);
    check_printable("calibration date", date);
    if (in.program_version().size() > max_version_chars)
        fail("a program version of {} characters is beyond the limit of {}",
             in.program_version().size(), max_version_chars);
    check_printable("program version", in.program_version());
    if (in.starting().size() > max_starting_chars)
        fail("a rig describes its start in {} characters, beyond the limit of {}",
             in.starting().size(), max_starting_chars);
    check_printable("description of a start", in.starting());
    if (in.keeps().size() > max_keeps_chars)
        fail("a line of {} characters about kept takes is beyond the limit of {}",
             in.keeps().size(), max_keeps_chars);
    check_printable("line about kept takes", in.keeps());
    RigHealth health;
    if (in.has_temperature_c()) health.temperature_c = in.temperature_c();
    health.under_voltage = in.under_voltage();
    health.captured_hz = in.captured_hz();
    health.published_hz = in.published_hz();
    health.calibration_id = in.calibration_id();
    health.calibration_date = date;
    health.calibration_row_rms_px = in.calibration_row_rms_px();
    health.program_version = in.program_version();
    health.refused_connections = in.refused_connections();
    health.starting = in.starting();
    health.keeps = in.keeps();
    return health;
}

FetchRequest from_wire(const wire::Fetch& in) {
    if (in.id() == 0) fail("a fetch without an id came");
    if (in.to_pulse() > max_trigger_index || in.from_pulse() >= in.to_pulse())
        fail("a fetch of the pulses from {} to before {} came, which is not a range up to {}",
             in.from_pulse(), in.to_pulse(), max_trigger_index);
    return {in.id(), in.from_pulse(), in.to_pulse(), in.granted()};
}

FetchState from_wire(const wire::Fetched& in) {
    if (in.id() == 0) fail("an answer to a fetch without an id came");
    check_sentence("trouble", in.trouble());
    return {in.id(), in.sent(), in.over(), in.trouble()};
}

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
    out.set_raw_pairs(message.raw_pairs);
    if (message.fetch) {
        wire::Fetch& fetch = *out.mutable_fetch();
        fetch.set_id(message.fetch->id);
        fetch.set_from_pulse(message.fetch->from_pulse);
        fetch.set_to_pulse(message.fetch->to_pulse);
        fetch.set_granted(message.fetch->granted);
    }
    out.set_report_id(message.report_id);
    if (message.tai_offset_s) out.set_tai_offset_s(*message.tai_offset_s);
    if (message.datagrams.offer != 0) {
        out.mutable_datagrams()->set_offer(message.datagrams.offer);
        out.mutable_datagrams()->set_trouble(
            message.datagrams.trouble.substr(0, max_refusal_chars));
    }
    return serialise(out);
}

HostMessage decode_host_message(std::span<const std::byte> part) {
    wire::HostMessage in;
    parse(part, "host message", in);
    check_schema_version("host message", in.schema_version());
    if (in.host_id() == 0) fail("a host message without host id came");
    if (in.credit_window() < 1 || in.credit_window() > max_datagram_credit_window)
        fail("a credit window of {} frames is outside 1..{}", in.credit_window(),
             max_datagram_credit_window);
    if (in.rate_divisor() < 1 || in.rate_divisor() > max_rate_divisor)
        fail("a rate divisor of {} is outside 1..{}", in.rate_divisor(), max_rate_divisor);
    if (in.first_pulse() > max_trigger_index)
        fail("a first pulse of {} is beyond {}", in.first_pulse(), max_trigger_index);
    HostMessage message{in.host_id(),   in.link(),         in.handled(),     in.credit_window(),
                        in.streaming(), in.rate_divisor(), in.first_pulse(), in.raw_pairs()};
    if (in.has_fetch()) message.fetch = from_wire(in.fetch());
    message.report_id = in.report_id();
    if (in.has_tai_offset_s()) message.tai_offset_s = in.tai_offset_s();
    if (in.datagrams().offer() != 0) {
        check_sentence("trouble", in.datagrams().trouble());
        message.datagrams = {in.datagrams().offer(), in.datagrams().trouble()};
    }
    return message;
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
    out.set_skipped(message.counters.skipped);
    to_wire(message.rig_counters, *out.mutable_counters());
    to_wire(message.sync, *out.mutable_sync());
    to_wire(message.health, *out.mutable_health());
    if (message.fetch) {
        wire::Fetched& fetch = *out.mutable_fetched();
        fetch.set_id(message.fetch->id);
        fetch.set_sent(message.fetch->sent);
        fetch.set_over(message.fetch->is_over);
        fetch.set_trouble(message.fetch->trouble.substr(0, max_refusal_chars));
    }
    out.set_report_id(message.report_id);
    out.set_refusal(message.refusal.substr(0, max_refusal_chars));
    out.set_refusal_passes(message.refusal_passes);
    if (message.offer.id != 0) {
        wire::DatagramOffer& offer = *out.mutable_datagrams();
        offer.set_id(message.offer.id);
        offer.set_port(message.offer.port);
        offer.set_passphrase(message.offer.passphrase);
    }
    out.set_sent_by_datagrams(message.sent_by_datagrams);
    out.set_datagram_trouble(message.datagram_trouble.substr(0, max_refusal_chars));
    return serialise(out);
}

RigMessage decode_rig_message(std::span<const std::byte> part) {
    wire::RigMessage in;
    parse(part, "rig message", in);
    check_schema_version("rig message", in.schema_version());
    check_name("rig", in.rig());
    check_sentence("refusal", in.refusal());
    if (in.refusal().empty() && in.link() == 0) fail("a rig message without link came");
    RigMessage message;
    message.rig = in.rig();
    message.session = in.session();
    message.link = in.link();
    message.counters = {in.offered(), in.sent(), in.send_dropped(), in.skipped()};
    message.rig_counters = from_wire(in.counters());
    message.sync = from_wire(in.sync());
    message.health = from_wire(in.health());
    if (in.has_fetched()) message.fetch = from_wire(in.fetched());
    message.report_id = in.report_id();
    message.refusal = in.refusal();
    message.refusal_passes = in.refusal_passes();
    if (in.has_datagrams()) message.offer = from_wire(in.datagrams());
    if (in.sent_by_datagrams() > in.sent())
        fail("a rig counts {} frames sent by datagrams of {} in all", in.sent_by_datagrams(),
             in.sent());
    message.sent_by_datagrams = in.sent_by_datagrams();
    check_sentence("trouble", in.datagram_trouble());
    message.datagram_trouble = in.datagram_trouble();
    return message;
}

}  // namespace vantage

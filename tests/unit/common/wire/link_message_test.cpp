#include "common/wire/link_message.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/wire/limits.h"
#include "link.pb.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using testing::HasSubstr;

std::vector<std::byte> bytes_of(const google::protobuf::MessageLite& message) {
    std::vector<std::byte> bytes(message.ByteSizeLong());
    message.SerializeToArray(bytes.data(), static_cast<int>(bytes.size()));
    return bytes;
}

template <class Decode>
std::string refusal_of(Decode decode, const std::vector<std::byte>& bytes) {
    return thrown_sentence([&] { decode(bytes); });
}

TEST(LinkMessage, HostMessageRoundTrips) {
    HostMessage sent{11, 12, 13, 14, false, 15, 16, true};
    EXPECT_EQ(decode_host_message(encode(sent)), sent);
    sent.fetch = {21, 22, 23, 24};
    sent.report_id = 25;
    EXPECT_EQ(decode_host_message(encode(sent)), sent);
}

/// Protobuf itself writes a line for each name that is no UTF-8, however many a peer sends.
TEST(LinkMessage, RefusesInvalidUtf8WithoutALogLine) {
    RigMessage sent;
    sent.rig = "rig-a";
    sent.link = 2;
    std::vector<std::byte> bytes = encode(sent);
    const std::string name = sent.rig;
    const auto at = std::search(bytes.begin(), bytes.end(), name.begin(), name.end(),
                                [](std::byte a, char b) { return a == std::byte(b); });
    ASSERT_NE(at, bytes.end());
    std::fill_n(at, name.size(), std::byte{0xff});
    testing::internal::CaptureStderr();
    const std::string refusal = refusal_of(decode_rig_message, bytes);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_NE(refusal, "");
}

TEST(LinkMessage, RigMessageRoundTrips) {
    RigMessage sent;
    sent.rig = "rig-a";
    sent.session = 1;
    sent.link = 2;
    sent.counters = {10, 5, 3, 2};
    sent.rig_counters = {20, 1, 2, 17, 3};
    sent.sync.role = RigSync::Role::follow;
    sent.sync.first_pulse = 4711;
    sent.sync.ptp_state = "SLAVE";
    sent.sync.ptp_offset_ns = -12.5;
    sent.sync.rate_hz = 29.97;
    sent.health = {61.5f,
                   true,
                   30,
                   29.5f,
                   "0123456789abcdef",
                   "2026-10-02T11:12:13Z",
                   0.125f,
                   "0.2.0",
                   900,
                   "compiling shaders, 7 of 21",
                   "keeps 2 of 4 files"};
    const RigMessage got = decode_rig_message(encode(sent));
    EXPECT_EQ(got.rig, sent.rig);
    EXPECT_EQ(got.session, sent.session);
    EXPECT_EQ(got.link, sent.link);
    EXPECT_EQ(got.counters, sent.counters);
    EXPECT_EQ(got.rig_counters, sent.rig_counters);
    EXPECT_EQ(got.sync, sent.sync);
    EXPECT_EQ(got.health, sent.health);
    EXPECT_EQ(got.fetch, std::nullopt);
    EXPECT_EQ(got.refusal, "");
    sent.fetch = {21, 22, true, "a trouble"};
    sent.report_id = 23;
    EXPECT_EQ(decode_rig_message(encode(sent)).fetch, sent.fetch);
    EXPECT_EQ(decode_rig_message(encode(sent)).report_id, 23u);
}

TEST(LinkMessage, AnOfferOfDatagramsAndItsAnswerRoundTrip) {
    RigMessage sent;
    sent.rig = "rig-a";
    sent.link = 2;
    sent.counters.sent = 5;
    sent.offer = {31, 5600, "a passphrase of this test"};
    sent.sent_by_datagrams = 4;
    sent.datagram_trouble = "a trouble";
    const RigMessage got = decode_rig_message(encode(sent));
    EXPECT_EQ(got.offer, sent.offer);
    EXPECT_EQ(got.sent_by_datagrams, 4u);
    EXPECT_EQ(got.datagram_trouble, "a trouble");
    HostMessage answer;
    answer.host_id = 1;
    answer.datagrams = {31, "another trouble"};
    EXPECT_EQ(decode_host_message(encode(answer)), answer);
}

TEST(LinkMessage, APassphraseIsNotAmongTheFirstBytesThatABugReportMayKeep) {
    RigMessage sent;
    sent.rig = "r";
    sent.link = 1;
    sent.health.program_version = "0.3.0";
    sent.health.captured_hz = 25;
    sent.offer = {31, 5600, "a passphrase of this test"};
    const std::vector<std::byte> bytes = encode(sent);
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    EXPECT_GE(text.find(sent.offer.passphrase), 32u);
    EXPECT_LT(text.find(sent.offer.passphrase), text.size());
}

TEST(LinkMessage, AMessageOfAnOlderEndHasNeitherOfferNorAnswer) {
    wire::RigMessage rig;
    rig.set_schema_version(wire_schema_version);
    rig.set_rig("rig-a");
    rig.set_link(5);
    EXPECT_EQ(decode_rig_message(bytes_of(rig)).offer, DatagramOffer{});
    wire::HostMessage host;
    host.set_schema_version(wire_schema_version);
    host.set_host_id(1);
    host.set_credit_window(1);
    host.set_rate_divisor(1);
    EXPECT_EQ(decode_host_message(bytes_of(host)).datagrams, DatagramAnswer{});
}

TEST(LinkMessage, ARefusalNeedsNoLinkAndIsCutToItsLimit) {
    RigMessage sent;
    sent.rig = "rig-a";
    sent.refusal = std::string(2000, 'x');
    EXPECT_EQ(decode_rig_message(encode(sent)).refusal, std::string(512, 'x'));
    EXPECT_FALSE(decode_rig_message(encode(sent)).refusal_passes);
    sent.refusal_passes = true;
    EXPECT_TRUE(decode_rig_message(encode(sent)).refusal_passes);
}

TEST(LinkMessage, HostileHostMessagesAreRefused) {
    const auto refusal = [](const std::function<void(wire::HostMessage&)>& spoil) {
        wire::HostMessage message;
        message.set_schema_version(wire_schema_version);
        message.set_host_id(1);
        message.set_credit_window(1);
        message.set_rate_divisor(1);
        spoil(message);
        return refusal_of(decode_host_message, bytes_of(message));
    };
    EXPECT_EQ(refusal([](auto&) {}), "");
    EXPECT_THAT(refusal([](auto& m) { m.set_schema_version(99); }), HasSubstr("version 99"));
    EXPECT_THAT(refusal([](auto& m) { m.clear_host_id(); }), HasSubstr("host id"));
    EXPECT_THAT(refusal([](auto& m) { m.clear_credit_window(); }), HasSubstr("credit window"));
    EXPECT_THAT(refusal([](auto& m) { m.set_credit_window(max_datagram_credit_window + 1); }),
                HasSubstr("credit window"));
    EXPECT_THAT(refusal([](auto& m) { m.clear_rate_divisor(); }), HasSubstr("rate divisor"));
    EXPECT_THAT(refusal([](auto& m) { m.set_rate_divisor(max_rate_divisor + 1); }),
                HasSubstr("rate divisor"));
    const auto fetch = [&](std::uint64_t id, std::uint64_t from, std::uint64_t to) {
        return refusal([&](auto& m) {
            m.mutable_fetch()->set_id(id);
            m.mutable_fetch()->set_from_pulse(from);
            m.mutable_fetch()->set_to_pulse(to);
        });
    };
    EXPECT_EQ(fetch(1, 5, 6), "");
    EXPECT_THAT(fetch(0, 5, 6), HasSubstr("without an id"));
    EXPECT_THAT(fetch(1, 6, 6), HasSubstr("pulses from 6 to before 6"));
    EXPECT_THAT(fetch(1, 7, 6), HasSubstr("pulses from 7"));
    EXPECT_THAT(fetch(1, 5, max_trigger_index + 1), HasSubstr("not a range up to"));
    EXPECT_THAT(refusal_of(decode_host_message, std::vector<std::byte>(max_header_bytes + 1)),
                HasSubstr("beyond the limit"));
    EXPECT_THAT(refusal_of(decode_host_message, {std::byte{0x08}}), HasSubstr("truncated"));
}

TEST(LinkMessage, HostileRigMessagesAreRefused) {
    const auto refusal = [](const std::function<void(wire::RigMessage&)>& spoil) {
        wire::RigMessage message;
        message.set_schema_version(wire_schema_version);
        message.set_rig("rig-a");
        message.set_link(5);
        spoil(message);
        return refusal_of(decode_rig_message, bytes_of(message));
    };
    EXPECT_EQ(refusal([](auto&) {}), "");
    EXPECT_THAT(refusal([](auto& m) { m.set_schema_version(0); }), HasSubstr("version 0"));
    EXPECT_THAT(refusal([](auto& m) { m.set_rig("a b"); }), HasSubstr("rig name"));
    EXPECT_THAT(refusal([](auto& m) { m.clear_link(); }), HasSubstr("without link"));
    EXPECT_THAT(refusal([](auto& m) { m.set_refusal(std::string(513, 'x')); }),
                HasSubstr("beyond the limit"));
    EXPECT_THAT(refusal([](auto& m) { m.set_refusal("red\x1b[31m"); }),
                HasSubstr("control characters"));
    EXPECT_THAT(refusal([](auto& m) { m.mutable_health()->set_captured_hz(NAN); }),
                HasSubstr("not finite"));
    EXPECT_THAT(refusal([](auto& m) { m.mutable_sync()->set_rate_hz(-1); }), HasSubstr("rate"));
    EXPECT_THAT(refusal([](auto& m) { m.mutable_health()->set_calibration_id("a b"); }),
                HasSubstr("calibration name"));
    EXPECT_THAT(
        refusal([](auto& m) { m.mutable_health()->set_calibration_date(std::string(41, '2')); }),
        HasSubstr("beyond the limit"));
    EXPECT_THAT(refusal([](auto& m) { m.mutable_health()->set_calibration_date("\x1b[2J"); }),
                HasSubstr("control characters"));
    EXPECT_THAT(
        refusal([](auto& m) { m.mutable_health()->set_program_version(std::string(41, '2')); }),
        HasSubstr("program version of 41"));
    EXPECT_THAT(refusal([](auto& m) { m.mutable_health()->set_program_version("\x1b[2J"); }),
                HasSubstr("control characters"));
    const auto offer = [&](std::uint64_t id, std::uint32_t port, const std::string& passphrase) {
        return refusal([&](auto& m) {
            m.mutable_datagrams()->set_id(id);
            m.mutable_datagrams()->set_port(port);
            m.mutable_datagrams()->set_passphrase(passphrase);
        });
    };
    EXPECT_EQ(offer(1, 5600, ""), "");
    EXPECT_EQ(offer(1, 65535, std::string(79, 'x')), "");
    EXPECT_THAT(offer(0, 5600, ""), HasSubstr("without an id"));
    EXPECT_THAT(offer(1, 0, ""), HasSubstr("port 0"));
    EXPECT_THAT(offer(1, 65536, ""), HasSubstr("port 65536"));
    EXPECT_THAT(offer(1, 5600, std::string(9, 'x')), HasSubstr("outside 10..79"));
    EXPECT_THAT(offer(1, 5600, std::string(80, 'x')), HasSubstr("outside 10..79"));
    EXPECT_THAT(offer(1, 5600, "0123456789\n"), HasSubstr("control characters"));
    EXPECT_THAT(refusal([](auto& m) { m.set_sent_by_datagrams(1); }), HasSubstr("of 0 in all"));
    EXPECT_THAT(refusal([](auto& m) { m.set_datagram_trouble(std::string(513, 'x')); }),
                HasSubstr("beyond the limit"));
    EXPECT_THAT(refusal_of(decode_rig_message, {std::byte{0x12}, std::byte{0x7f}}),
                HasSubstr("truncated"));
}

}  // namespace
}  // namespace vantage

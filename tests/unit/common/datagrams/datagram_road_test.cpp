// Both ends of the road of datagrams, and rig and host with it, over real sockets.
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <zmq.hpp>
#include <zmq_addon.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include "common/base/files/unique_fd.h"
#include "common/config/endpoint.h"
#include "common/datagrams/datagram_link.h"
#include "common/datagrams/datagram_server.h"
#include "common/receive/stage_receiver.h"
#include "common/wire/zmq_helpers.h"
#include "rig_firmware/stream/publisher.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"
#include "tests/support/keyed_stream.h"
#include "tests/support/thrown_sentence.h"
#include "tests/support/wire_frames.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr auto patience = 60s;

SocketAddress loopback(int port = 0) { return resolve_all("127.0.0.1", port).front(); }

/// A rig's end on its own.
class DatagramRoad : public testing::Test {
  protected:
    DatagramServer::Road serve(const DatagramAnswer& answer = {}) {
        return server_.serve({{link, "the host", answer}}, MonotonicClock::now()).at(0);
    }
    bool opens(const DatagramLink& host) {
        return eventually([&] {
            const bool is_open = serve().is_open;
            return is_open && host.state().is_open;
        });
    }
    static constexpr std::uint64_t link = 3;
    DatagramServer server_{{loopback()}, "rig-a", "stream.road"};
    WakeEvent arrived_;
};

TEST_F(DatagramRoad, CarriesMessagesInOrder) {
    const DatagramLink host_of_nothing(loopback(), {9, server_.port(), "a passphrase, not offered"},
                                       arrived_);
    DatagramLink host(loopback(), serve().offer, arrived_);
    ASSERT_TRUE(opens(host)) << host.state().trouble;
    constexpr unsigned messages = 50;
    for (unsigned i = 0; i < messages; ++i) {
        const std::vector<std::byte> colour(1000 * i, static_cast<std::byte>(i));
        ASSERT_TRUE(eventually([&] { return serve().room_bytes > 200'000; }));
        ASSERT_TRUE(server_.send(link, {std::as_bytes(std::span("head")), {}, colour, {}}));
        std::optional<std::vector<std::byte>> message;
        ASSERT_TRUE(eventually([&] { return (message = host.next()).has_value(); }));
        const FrameParts parts = split_message(*message, host.offer().passphrase);
        EXPECT_TRUE(std::ranges::equal(parts[2], colour));
    }
    EXPECT_EQ(host.state().damaged, 0u);
    ASSERT_TRUE(eventually([&] { return !host_of_nothing.state().trouble.empty(); }));
    EXPECT_FALSE(host_of_nothing.state().is_open);
    EXPECT_GE(server_.refused(), 1u);
}

TEST_F(DatagramRoad, OpensToTheOffersPassphraseOnly) {
    const DatagramOffer offer = serve().offer;
    EXPECT_GE(offer.passphrase.size(), 32u);
    std::string wrong = offer.passphrase;
    wrong.back() = wrong.back() == '0' ? '1' : '0';
    for (const std::string& passphrase : {wrong, std::string()}) {
        DatagramOffer stolen = offer;
        stolen.passphrase = passphrase;
        const DatagramLink stranger(loopback(), stolen, arrived_);
        ASSERT_TRUE(eventually([&] {
            EXPECT_FALSE(serve().is_open);
            return !stranger.state().trouble.empty();
        })) << passphrase;
        EXPECT_FALSE(stranger.state().is_open);
        EXPECT_THAT(stranger.state().trouble, HasSubstr("cannot connect"));
    }
    // The offer still stands for whoever knows it, and for one connection.
    const DatagramLink host(loopback(), offer, arrived_);
    ASSERT_TRUE(opens(host)) << host.state().trouble;
    const DatagramLink second(loopback(), offer, arrived_);
    ASSERT_TRUE(eventually([&] { return !second.state().trouble.empty(); }));
    EXPECT_TRUE(serve().is_open);
}

TEST_F(DatagramRoad, AnOfferThatDidNotWorkIsWithdrawnAndRenewedLater) {
    const DatagramOffer offer = serve().offer;
    const DatagramAnswer answer{offer.id, "the way is blocked"};
    const MonotonicTime now = MonotonicClock::now();
    const auto road_at = [&](MonotonicTime when) {
        return server_.serve({{link, "the host", answer}}, when).at(0);
    };
    EXPECT_EQ(road_at(now).offer.id, 0u);
    EXPECT_EQ(road_at(now).trouble, "the way is blocked");
    EXPECT_EQ(road_at(now + DatagramServer::retry_period / 2).offer.id, 0u);
    const DatagramServer::Road again = road_at(now + DatagramServer::retry_period + 1s);
    EXPECT_NE(again.offer.id, 0u);
    EXPECT_NE(again.offer.id, offer.id);
    EXPECT_NE(again.offer.passphrase, offer.passphrase);
    const DatagramLink late(loopback(), offer, arrived_);
    ASSERT_TRUE(eventually([&] { return !late.state().trouble.empty(); }));
}

TEST_F(DatagramRoad, EndsWhenTheHostLeaves) {
    auto host = std::make_unique<DatagramLink>(loopback(), serve().offer, arrived_);
    ASSERT_TRUE(opens(*host)) << host->state().trouble;
    host.reset();
    ASSERT_TRUE(eventually([&] { return !serve().is_open; }));
    EXPECT_THAT(serve().trouble, HasSubstr("broke"));
    EXPECT_FALSE(server_.send(link, {}));
}

TEST_F(DatagramRoad, HasNoRoomWhileAFrameIsNotAcknowledged) {
    const DatagramLink host(loopback(), serve().offer, arrived_);
    ASSERT_TRUE(opens(host)) << host.state().trouble;
    ASSERT_TRUE(eventually([&] { return serve().room_bytes > 1000; }));
    // It is sent now, and looked at later than an acknowledgement takes.
    const MonotonicTime later =
        MonotonicClock::now() + DatagramServer::oldest_under_way + std::chrono::milliseconds(100);
    const std::vector<std::byte> colour(200'000);
    ASSERT_TRUE(server_.send(link, FrameParts{{{}, {}, colour, {}}}));
    EXPECT_EQ(server_.serve({{link, "the host", {}}}, later).at(0).room_bytes, 0u);
    ASSERT_TRUE(eventually([&] { return serve().room_bytes > 1000; }));
}

TEST_F(DatagramRoad, AHostThatIsNoPeerLosesIt) {
    const DatagramLink host(loopback(), serve().offer, arrived_);
    ASSERT_TRUE(opens(host)) << host.state().trouble;
    server_.serve({}, MonotonicClock::now());
    ASSERT_TRUE(eventually([&] { return !host.state().trouble.empty(); }));
    EXPECT_FALSE(host.state().is_open);
}

TEST_F(DatagramRoad, APortInUseIsNamed) {
    EXPECT_THAT(thrown_sentence([&] {
                    const DatagramServer second({loopback(server_.port())}, "rig-b", "stream.road");
                }),
                testing::AllOf(HasSubstr("UDP port 127.0.0.1:"), HasSubstr("stream.bind")));
}

/// A rig and a host in one process.
class SrtLink : public testing::Test {
  protected:
    RigConfig::Stream stream(const std::string& road) {
        RigConfig::Stream stream = keyed_stream(folder_.path());
        stream.bind = "tcp://127.0.0.1:*";
        stream.jpeg_quality = 0;
        stream.road = road;
        return stream;
    }
    StageConfig stage_of(const Publisher& rig) const {
        StageConfig stage;
        stage.rigs.push_back({"rig-a", rig.endpoint(), rig.public_key()});
        stage.key_file = folder_.path() / "host.key";
        return stage;
    }
    static bool is_balanced(const RigStatus& rig) {
        return rig.link.offered == rig.link.sent + rig.link.send_dropped + rig.link.skipped &&
               rig.link.sent == rig.received + rig.lost && rig.rig_counters.published > 0;
    }
    TemporaryFolder folder_;
};

TEST_F(SrtLink, FramesComeByDatagramsBitExact) {
    Publisher rig(stream("srt"), "rig-a");
    StageReceiver host(stage_of(rig));
    ASSERT_TRUE(eventually([&] { return host.status().rigs[0].by_datagrams; }));
    ASSERT_TRUE(eventually([&] { return rig.status().hosts.at(0).by_datagrams; }));
    constexpr std::uint64_t frames = 20;
    for (std::uint64_t k = 1000; k < 1000 + frames; ++k) {
        const RigFrame sent = make_frame(k);
        rig.publish(sent);
        const std::optional<FrameSet> set = host.next(patience);
        ASSERT_TRUE(set && set->present() == 1);
        EXPECT_EQ(set->slots[0].frame->trigger_index, k);
        EXPECT_TRUE(same_pixels(set->slots[0].frame->colour, sent.colour));
        EXPECT_TRUE(same_pixels(set->slots[0].frame->disparity, sent.disparity));
    }
    ASSERT_TRUE(eventually([&] { return is_balanced(host.status().rigs[0]); }));
    const RigStatus status = host.status().rigs[0];
    EXPECT_EQ(status.received, frames);
    EXPECT_EQ(status.lost, 0u);
    EXPECT_EQ(status.undecodable, 0u) << status.last_error;
    EXPECT_EQ(status.datagram_trouble, "");
}

TEST_F(SrtLink, AFrameThatIsTooLargeForDatagramsComesOverTcp) {
    Publisher rig(stream("srt"), "rig-a");
    StageReceiver host(stage_of(rig));
    ASSERT_TRUE(eventually([&] {
        return host.status().rigs[0].by_datagrams && rig.status().hosts.at(0).by_datagrams;
    }));
    const auto packed = rig.publish(make_frame(1000, 3000, 1900));
    ASSERT_GT(packed->bytes(), max_datagram_message_bytes);
    rig.publish(make_frame(1001));
    ASSERT_TRUE(eventually([&] { return host.status().rigs[0].received == 2; }));
    ASSERT_TRUE(eventually([&] { return is_balanced(host.status().rigs[0]); }));
    EXPECT_EQ(host.status().rigs[0].lost, 0u);
}

TEST_F(SrtLink, ARigWithTheRoadTcpListensForNoDatagrams) {
    Publisher rig(stream("tcp"), "rig-a");
    const Endpoint endpoint = parse_endpoint(rig.endpoint(), "endpoint");
    const UniqueFd socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    const SocketAddress address = loopback(std::stoi(endpoint.port));
    EXPECT_EQ(::bind(socket.get(), address.get(), address.size), 0);
    StageReceiver host(stage_of(rig));
    ASSERT_TRUE(eventually([&] { return host.status().rigs[0].connected; }));
    rig.publish(make_frame(1000));
    ASSERT_TRUE(host.next(patience));
    EXPECT_FALSE(host.status().rigs[0].by_datagrams);
    EXPECT_EQ(host.status().rigs[0].datagram_trouble, "");
}

TEST_F(SrtLink, DatagramsAreBoundAtTheAddressOfTheTcpSocketAlone) {
    RigConfig::Stream config = stream("srt");
    const UniqueFd chooser(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    SocketAddress free = loopback();
    ASSERT_EQ(::bind(chooser.get(), free.get(), free.size), 0);
    ASSERT_EQ(::getsockname(chooser.get(), reinterpret_cast<sockaddr*>(&free.bytes), &free.size),
              0);
    // On the other address the port is taken already.
    const std::string text = free.text();
    config.bind = "tcp://127.0.0.2:" + text.substr(text.rfind(':') + 1);
    const Publisher rig(config, "rig-a");
    const UniqueFd second(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    const SocketAddress used =
        resolve_all("127.0.0.2", std::stoi(text.substr(text.rfind(':') + 1))).front();
    EXPECT_NE(::bind(second.get(), used.get(), used.size), 0);
}

/// A host of which the test writes every message, without keys.
class ScriptedPeer {
  public:
    explicit ScriptedPeer(const std::string& endpoint)
        : socket_(context_, zmq::socket_type::dealer) {
        socket_.set(zmq::sockopt::linger, 0);
        socket_.set(zmq::sockopt::rcvtimeo, option_ms(100ms));
        socket_.connect(endpoint);
        request_.host_id = 9;
        request_.credit_window = 4;
    }

    /// Speaks and listens until a message satisfies the condition.
    template <class Condition>
    bool until(Condition condition) {
        return eventually([&] {
            socket_.send(zmq::buffer(encode(request_)), zmq::send_flags::none);
            std::vector<zmq::message_t> parts;
            if (!zmq::recv_multipart(socket_, std::back_inserter(parts))) return false;
            const RigMessage message = decode_rig_message(bytes_of(parts.at(0)));
            request_.link = message.link;
            if (parts.size() == 4) {
                ++frames_;
                request_.handled = message.counters.sent;
            }
            if (!message.offer.passphrase.empty()) offer_ = message.offer;
            return condition(message);
        });
    }
    zmq::context_t context_;
    zmq::socket_t socket_;
    HostMessage request_;
    DatagramOffer offer_;
    std::uint64_t frames_ = 0;
};

RigConfig::Stream open_stream() {
    RigConfig::Stream stream;
    stream.bind = "tcp://127.0.0.1:*";
    stream.jpeg_quality = 0;
    stream.road = "srt";
    return stream;
}

TEST(SrtFallback, AnOldHostThatIgnoresTheOfferGetsItsFramesOverTcp) {
    Publisher rig(open_stream(), "rig-a");
    ScriptedPeer host(rig.endpoint());
    ASSERT_TRUE(host.until([&](const RigMessage& message) { return message.offer.id != 0; }));
    for (std::uint64_t k = 1; k <= 5; ++k) {
        rig.publish(make_frame(k));
        ASSERT_TRUE(host.until([&](const RigMessage&) { return host.frames_ == k; }));
    }
    EXPECT_EQ(rig.status().hosts.at(0).counters.sent, 5u);
    EXPECT_FALSE(rig.status().hosts.at(0).by_datagrams);
}

TEST(SrtFallback, AHostWithoutAskingForFramesIsOfferedNothing) {
    Publisher rig(open_stream(), "rig-a");
    ScriptedPeer host(rig.endpoint());
    host.request_.streaming = false;
    int messages = 0;
    ASSERT_TRUE(host.until([&](const RigMessage& message) {
        EXPECT_EQ(message.offer.id, 0u);
        return ++messages == 5;
    }));
}

TEST(SrtFallback, FramesGoOverTcpOnceTheRoadEndedAndBothEndsKnowWhy) {
    Publisher rig(open_stream(), "rig-a");
    ScriptedPeer host(rig.endpoint());
    ASSERT_TRUE(host.until([&](const RigMessage&) { return host.offer_.id != 0; }));
    WakeEvent arrived;
    auto road = std::make_unique<DatagramLink>(loopback(), host.offer_, arrived);
    ASSERT_TRUE(host.until([&](const RigMessage&) {
        return rig.status().hosts.at(0).by_datagrams && road->state().is_open;
    }));
    rig.publish(make_frame(1));
    std::optional<std::vector<std::byte>> message;
    ASSERT_TRUE(eventually([&] { return (message = road->next()).has_value(); }));
    const RigMessage first = decode_rig_message(split_message(*message, host.offer_.passphrase)[0]);
    EXPECT_EQ(first.counters.sent, 1u);
    EXPECT_EQ(first.sent_by_datagrams, 1u);
    EXPECT_EQ(first.offer.passphrase, "");
    host.request_.handled = 1;

    road.reset();
    const std::uint64_t ended = host.offer_.id;
    host.request_.datagrams = {ended, "the host's cable was pulled"};
    ASSERT_TRUE(host.until([&](const RigMessage& said) { return !said.datagram_trouble.empty(); }));
    rig.publish(make_frame(2));
    std::optional<RigMessage> second;
    ASSERT_TRUE(host.until([&](const RigMessage& said) {
        second = said;
        return host.frames_ == 1;
    }));
    EXPECT_EQ(second->counters.sent, 2u);
    EXPECT_EQ(second->sent_by_datagrams, 1u);
    EXPECT_NE(second->offer.id, ended);
}

}  // namespace
}  // namespace vantage

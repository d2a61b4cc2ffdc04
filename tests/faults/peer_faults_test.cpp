// Peers of a rig that are none, and a live stream beside them that must not notice.
#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <memory>
#include <string>
#include <vector>
#include <zmq.hpp>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include "common/base/files/unique_fd.h"
#include "common/base/log.h"
#include "common/receive/stage_receiver.h"
#include "common/wire/curve_keys.h"
#include "common/wire/link_message.h"
#include "rig_firmware/stream/publisher.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"
#include "tests/support/wire_frames.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr int beats_beside = 25;

std::size_t log_lines_with(const std::string& words) {
    const std::vector<std::string> lines = recent_log_lines();
    return static_cast<std::size_t>(
        std::count_if(lines.begin(), lines.end(),
                      [&](const std::string& line) { return line.find(words) != line.npos; }));
}

UniqueFd listening_socket(sockaddr_in& place) {
    UniqueFd listener(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    place.sin_family = AF_INET;
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::bind(listener.get(), reinterpret_cast<sockaddr*>(&place), sizeof place), 0);
    EXPECT_EQ(::listen(listener.get(), 1), 0);
    socklen_t size = sizeof place;
    EXPECT_EQ(::getsockname(listener.get(), reinterpret_cast<sockaddr*>(&place), &size), 0);
    return listener;
}

/// A rig with keys that streams to its host. What a stranger does beside is done by the test.
class PeerFaults : public testing::Test {
  protected:
    void SetUp() override {
        write_key_file(folder_.path() / "host.key", host_keys_);
        write_key_file(folder_.path() / "rig.key", generate_curve_keys());
        std::ofstream(folder_.path() / "hosts.keys") << host_keys_.public_key << " the host\n";
        RigConfig::Stream stream;
        stream.bind = "tcp://127.0.0.1:*";
        stream.jpeg_quality = 0;
        stream.key_file = folder_.path() / "rig.key";
        stream.authorized_hosts = folder_.path() / "hosts.keys";
        rig_ = std::make_unique<Publisher>(stream, name_);
        place_.sin_family = AF_INET;
        place_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        place_.sin_port = htons(static_cast<std::uint16_t>(
            std::stoi(rig_->endpoint().substr(rig_->endpoint().rfind(':') + 1))));
        host_ = std::make_unique<StageReceiver>(stage_at(rig_->endpoint()));
        ASSERT_TRUE(eventually([&] { return host_->status().rigs[0].connected; }));
        beat();
    }

    StageConfig stage_at(const std::string& endpoint) const {
        StageConfig stage;
        stage.rigs.push_back({name_, endpoint, rig_->public_key()});
        stage.key_file = folder_.path() / "host.key";
        return stage;
    }

    /// A frame that the host gets before the next one is filmed: none is dropped for slowness.
    void beat() {
        rig_->publish(make_frame(1000 + beats_));
        ++beats_;
        ASSERT_TRUE(eventually([&] { return host_->status().rigs[0].received == beats_; }));
        while (host_->next(0s)) {
        }
    }
    void beat(int times) {
        for (int i = 0; i < times && !HasFatalFailure(); ++i) beat();
    }

    UniqueFd connected_socket() const {
        UniqueFd socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
        if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&place_), sizeof place_) != 0)
            return {};
        return socket;
    }

    /// A line in ten seconds, however long this took.
    std::size_t most_lines() const {
        const auto so_far = std::chrono::steady_clock::now() - started_;
        return 1 + static_cast<std::size_t>(so_far / 10s);
    }

    /// Connections were refused, and the log says so in these words, as often as a line may come.
    void is_in_the_log(const std::string& words) const {
        const auto lines = [&] {
            const std::vector<std::string> all = recent_log_lines();
            return static_cast<std::size_t>(
                std::count_if(all.begin(), all.end(), [&](const std::string& line) {
                    return line.find(" rig " + name_ + ": ") != line.npos &&
                           line.find(words) != line.npos;
                }));
        };
        EXPECT_TRUE(eventually([&] { return lines() > 0; })) << words;
        EXPECT_LE(lines(), most_lines()) << words;
    }

    /// The host has every frame, by the connection that it always had, and is the only one.
    void nothing_was_noticed() const {
        const RigStatus status = host_->status().rigs[0];
        EXPECT_EQ(status.received, beats_);
        EXPECT_EQ(status.lost, 0u);
        EXPECT_EQ(status.link.send_dropped, 0u);
        EXPECT_EQ(status.undecodable, 0u);
        const PublisherStatus rig = rig_->status();
        ASSERT_EQ(rig.hosts.size(), 1u);
        EXPECT_EQ(rig.hosts[0].host_key, host_keys_.public_key);
    }

    /// Its own for each test: those of one process share the log.
    const std::string name_ = testing::UnitTest::GetInstance()->current_test_info()->name();
    TemporaryFolder folder_;
    const CurveKeys host_keys_ = generate_curve_keys();
    std::unique_ptr<Publisher> rig_;
    std::unique_ptr<StageReceiver> host_;
    sockaddr_in place_{};
    std::uint64_t beats_ = 0;
    const std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

TEST_F(PeerFaults, GarbageIsLeftAlone) {
    std::vector<UniqueFd> strangers;
    for (unsigned i = 0; i < 20; ++i) {
        UniqueFd stranger = connected_socket();
        ASSERT_TRUE(stranger);
        std::vector<unsigned char> garbage(4096);
        for (std::size_t j = 0; j < garbage.size(); ++j)
            garbage[j] = static_cast<unsigned char>((j + 1) * 2654435761u * (i + 1) >> 7);
        // One of two begins as a peer of ZeroMQ does.
        if (i % 2 == 0) {
            const unsigned char greeting[] = {0xff, 0, 0, 0, 0, 0, 0, 0, 1, 0x7f, 3, 0};
            std::copy(std::begin(greeting), std::end(greeting), garbage.begin());
        }
        EXPECT_GT(::send(stranger.get(), garbage.data(), garbage.size(), MSG_NOSIGNAL), 0);
        strangers.push_back(std::move(stranger));
        beat();
    }
    beat(beats_beside);
    nothing_was_noticed();
    is_in_the_log("does not speak Vantage's protocol");
    is_in_the_log("connected without a key");
    EXPECT_EQ(rig_->status().refused_connections, 20u);
}

TEST_F(PeerFaults, AThousandConnectionsThatSayNothingAreServedAround) {
    rlimit files{};
    getrlimit(RLIMIT_NOFILE, &files);
    files.rlim_cur = files.rlim_max;
    setrlimit(RLIMIT_NOFILE, &files);
    if (files.rlim_max < 4096)
        GTEST_SKIP() << "SKIPPED: no more than " << files.rlim_max << " files";
    std::vector<UniqueFd> strangers;
    for (int i = 0; i < 1000; ++i) {
        strangers.push_back(connected_socket());
        ASSERT_TRUE(strangers.back()) << i;
        if (i % 50 == 0) beat();
    }
    beat(beats_beside);
    nothing_was_noticed();
    // Who is welcome still comes in.
    const StageReceiver second(stage_at(rig_->endpoint()), StageReceiver::Purpose::observe);
    EXPECT_TRUE(eventually([&] { return second.status().rigs[0].connected; }));
    is_in_the_log("from 127.0.0.1, did not finish the handshake within 5 s");
    EXPECT_TRUE(eventually([&] { return rig_->status().refused_connections == 1000; }));
    EXPECT_TRUE(
        eventually([&] { return host_->status().rigs[0].health.refused_connections == 1000; }));
    strangers.clear();
    beat();
}

TEST_F(PeerFaults, ConnectionsThatComeAndGoAreServedAround) {
    for (int i = 0; i < 1000; ++i) {
        ASSERT_TRUE(connected_socket()) << i;
        if (i % 50 == 0) beat();
    }
    beat(beats_beside);
    nothing_was_noticed();
    is_in_the_log("closed the connection before the handshake");
    EXPECT_TRUE(eventually([&] { return rig_->status().refused_connections == 1000; }));
}

TEST_F(PeerFaults, HandshakesWithoutKeyAndForgedOnesOpenNothing) {
    // ZeroMQ's own peers without a key may leave first, as they see that keys are asked for.
    std::array<unsigned char, 64> greeting{0xff, 0, 0, 0, 0, 0, 0, 0, 1, 0x7f, 3, 0};
    std::copy_n("NULL", 4, greeting.begin() + 12);
    std::vector<UniqueFd> keyless;
    zmq::context_t context;
    const std::string other_rig = generate_curve_keys().public_key;
    std::vector<zmq::socket_t> forgers;
    for (int i = 0; i < 25; ++i) {
        keyless.push_back(connected_socket());
        ASSERT_GT(::send(keyless.back().get(), greeting.data(), greeting.size(), MSG_NOSIGNAL), 0);
        zmq::socket_t socket(context, zmq::socket_type::dealer);
        socket.set(zmq::sockopt::linger, 0);
        socket.set(zmq::sockopt::reconnect_ivl, 1);
        socket.set(zmq::sockopt::curve_serverkey, other_rig);
        socket.set(zmq::sockopt::curve_publickey, host_keys_.public_key);
        socket.set(zmq::sockopt::curve_secretkey, host_keys_.secret_key);
        socket.connect(rig_->endpoint());
        forgers.push_back(std::move(socket));
    }
    is_in_the_log("connected without a key");
    is_in_the_log("does not have this rig's public key, or repeated or forged a handshake");
    beat(beats_beside);
    nothing_was_noticed();
}

TEST_F(PeerFaults, AFloodOfStrangersKeysIsRefusedAndSaidOnce) {
    zmq::context_t context;
    const CurveKeys stranger_keys = generate_curve_keys();
    std::vector<zmq::socket_t> strangers;
    for (int i = 0; i < 50; ++i) {
        zmq::socket_t socket(context, zmq::socket_type::dealer);
        socket.set(zmq::sockopt::linger, 0);
        socket.set(zmq::sockopt::reconnect_ivl, 1);
        socket.set(zmq::sockopt::curve_serverkey, rig_->public_key());
        socket.set(zmq::sockopt::curve_publickey, stranger_keys.public_key);
        socket.set(zmq::sockopt::curve_secretkey, stranger_keys.secret_key);
        socket.connect(rig_->endpoint());
        strangers.push_back(std::move(socket));
    }
    const std::string refused = "with key " + stranger_keys.public_key;
    ASSERT_TRUE(eventually([&] { return log_lines_with(refused) > 0; }));
    beat(beats_beside);
    nothing_was_noticed();
    EXPECT_LE(log_lines_with(refused), most_lines());
}

TEST_F(PeerFaults, AHostThatFloodsIsAnsweredAFewTimesAndSaidOnce) {
    const std::string refused = "messages that are no host's were refused";
    const std::size_t lines_before = log_lines_with(refused);
    // It holds a key that is authorized, and does not speak Vantage's protocol.
    zmq::context_t context;
    zmq::socket_t socket(context, zmq::socket_type::dealer);
    socket.set(zmq::sockopt::linger, 0);
    socket.set(zmq::sockopt::curve_serverkey, rig_->public_key());
    socket.set(zmq::sockopt::curve_publickey, host_keys_.public_key);
    socket.set(zmq::sockopt::curve_secretkey, host_keys_.secret_key);
    socket.connect(rig_->endpoint());
    for (int i = 0; i < 5000; ++i) {
        (void)socket.send(zmq::str_buffer("\xff\x07garbage"), zmq::send_flags::none);
        if (i % 500 == 0) beat();
    }
    ASSERT_TRUE(eventually([&] { return rig_->status().malformed == 5000; }));
    beat(beats_beside);
    nothing_was_noticed();
    const std::size_t lines = log_lines_with(refused) - lines_before;
    EXPECT_GE(lines, 1u);
    EXPECT_LE(lines, most_lines());
}

TEST_F(PeerFaults, AReplayedHandshakeOpensNothing) {
    // A second host of the same key comes by a road on which somebody writes all of it down.
    sockaddr_in road_place{};
    const UniqueFd road = listening_socket(road_place);
    auto second = std::make_unique<StageReceiver>(
        stage_at(fmt::format("tcp://127.0.0.1:{}", ntohs(road_place.sin_port))),
        StageReceiver::Purpose::observe);
    const UniqueFd to_host(::accept(road.get(), nullptr, nullptr)), to_rig = connected_socket();
    ASSERT_TRUE(to_host && to_rig);
    std::vector<char> written_down;
    std::array<char, 65536> bytes;
    const auto carry = [&] {
        pollfd ends[] = {{to_host.get(), POLLIN, 0}, {to_rig.get(), POLLIN, 0}};
        if (::poll(ends, 2, 10) <= 0) return;
        for (const int from : {0, 1}) {
            if ((ends[from].revents & POLLIN) == 0) continue;
            const ssize_t count = ::recv(ends[from].fd, bytes.data(), bytes.size(), 0);
            if (count <= 0) continue;
            if (from == 0)
                written_down.insert(written_down.end(), bytes.data(), bytes.data() + count);
            (void)::send(ends[1 - from].fd, bytes.data(), static_cast<std::size_t>(count),
                         MSG_NOSIGNAL);
        }
    };
    ASSERT_TRUE(eventually([&] {
        carry();
        return second->status().rigs[0].connected;
    }));
    ASSERT_EQ(rig_->status().hosts.size(), 2u) << "the way written down is a good one";
    second.reset();

    for (int i = 0; i < 5; ++i) {
        const UniqueFd again = connected_socket();
        ASSERT_TRUE(again);
        ASSERT_GT(::send(again.get(), written_down.data(), written_down.size(), MSG_NOSIGNAL), 0);
        // The rig answers as far as it can be said without the secret, and then closes.
        pollfd item{again.get(), POLLIN, 0};
        ssize_t count = 1;
        while (count > 0 && ::poll(&item, 1, 60'000) == 1)
            count = ::recv(again.get(), bytes.data(), bytes.size(), 0);
        EXPECT_LE(count, 0) << "closed by the rig";
        beat();
    }
    beat(beats_beside);
    EXPECT_EQ(rig_->status().hosts.size(), 2u) << "no third came in";
    EXPECT_EQ(rig_->status().hosts[1].counters.sent, 0u);
    EXPECT_EQ(rig_->status().malformed, 0u);
    is_in_the_log("does not have this rig's public key, or repeated or forged a handshake");
    const RigStatus status = host_->status().rigs[0];
    EXPECT_EQ(status.received, beats_);
    EXPECT_EQ(status.lost + status.link.send_dropped, 0u);
}

TEST_F(PeerFaults, ASlowReaderLosesItsOwnFramesOnly) {
    zmq::context_t context;
    zmq::socket_t slow(context, zmq::socket_type::dealer);
    slow.set(zmq::sockopt::linger, 0);
    slow.set(zmq::sockopt::rcvhwm, 1);
    slow.set(zmq::sockopt::curve_serverkey, rig_->public_key());
    slow.set(zmq::sockopt::curve_publickey, host_keys_.public_key);
    slow.set(zmq::sockopt::curve_secretkey, host_keys_.secret_key);
    slow.connect(rig_->endpoint());
    // It grants as many frames as may be and takes none.
    HostMessage request;
    request.host_id = 9;
    request.credit_window = 16;
    request.streaming = true;
    const auto say = [&] {
        const std::vector<std::byte> message = encode(request);
        (void)slow.send(zmq::buffer(message), zmq::send_flags::none);
    };
    say();
    ASSERT_TRUE(eventually([&] { return rig_->status().hosts.size() == 2; }));
    for (int i = 0; i < 100 && !HasFatalFailure(); ++i) {
        say();
        beat();
    }
    const RigStatus status = host_->status().rigs[0];
    EXPECT_EQ(status.received, beats_);
    EXPECT_EQ(status.lost + status.link.send_dropped, 0u);
    const HostLinks::HostStatus other = rig_->status().hosts[1];
    EXPECT_GT(other.counters.send_dropped, 0u);
    EXPECT_EQ(other.counters.offered,
              other.counters.sent + other.counters.send_dropped + other.queued);
    is_in_the_log("hosts were too slow");
}

}  // namespace
}  // namespace vantage

#include "common/serve/stranger_watch.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>
#include <zmq.hpp>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include "common/base/files/unique_fd.h"
#include "common/base/log.h"
#include "common/serve/frame_server.h"
#include "common/wire/curve_keys.h"
#include "common/wire/link_message.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

std::vector<std::string> lines_with(const std::string& rig, const std::string& words) {
    std::vector<std::string> found;
    for (const std::string& line : recent_log_lines())
        if (line.find("rig " + rig + ": ") != line.npos && line.find(words) != line.npos)
            found.push_back(line);
    return found;
}

UniqueFd connection_to(const std::string& endpoint) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    place.sin_port =
        htons(static_cast<std::uint16_t>(std::stoi(endpoint.substr(endpoint.rfind(':') + 1))));
    UniqueFd socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    EXPECT_EQ(::connect(socket.get(), reinterpret_cast<const sockaddr*>(&place), sizeof place), 0);
    return socket;
}

void say(const UniqueFd& socket, std::string_view words) {
    EXPECT_GT(::send(socket.get(), words.data(), words.size(), MSG_NOSIGNAL), 0);
}

/// A rig with keys, which lists one host.
class StrangerWatchTest : public testing::Test {
  protected:
    void serve(const std::string& rig) {
        write_key_file(folder_.path() / "rig.key", generate_curve_keys());
        std::ofstream(folder_.path() / "hosts.keys") << host_.public_key << " the host\n";
        FrameServer::Settings settings;
        settings.bind = "tcp://127.0.0.1:*";
        settings.key_file = folder_.path() / "rig.key";
        settings.authorized_hosts = folder_.path() / "hosts.keys";
        server_ = std::make_unique<FrameServer>(settings, rig, 42);
    }

    zmq::socket_t peer(const CurveKeys& own, const std::string& rig_key) {
        zmq::socket_t socket(context_, zmq::socket_type::dealer);
        socket.set(zmq::sockopt::linger, 0);
        socket.set(zmq::sockopt::curve_serverkey, rig_key);
        socket.set(zmq::sockopt::curve_publickey, own.public_key);
        socket.set(zmq::sockopt::curve_secretkey, own.secret_key);
        socket.connect(server_->endpoint());
        return socket;
    }

    bool is_refused() {
        return eventually([&] { return server_->refused_connections() > 0; });
    }

    TemporaryFolder folder_;
    const CurveKeys host_ = generate_curve_keys();
    zmq::context_t context_;
    std::unique_ptr<FrameServer> server_;
};

TEST_F(StrangerWatchTest, ReportsAConnectionClosedBeforeTheHandshake) {
    serve("left");
    connection_to(server_->endpoint());
    ASSERT_TRUE(is_refused());
    EXPECT_TRUE(eventually([] {
        return lines_with("left", "closed the connection before the handshake").size() == 1;
    }));
}

TEST_F(StrangerWatchTest, ReportsAnotherProtocol) {
    serve("foreign");
    const UniqueFd browser = connection_to(server_->endpoint());
    say(browser, "GET / HTTP/1.1\r\nHost: rig\r\n\r\n");
    ASSERT_TRUE(is_refused());
    EXPECT_TRUE(eventually(
        [] { return lines_with("foreign", "does not speak Vantage's protocol").size() == 1; }));
}

TEST_F(StrangerWatchTest, ReportsAConnectionWithoutKey) {
    serve("keyless");
    // One of ZeroMQ's own may leave first, as it sees that keys are asked for.
    const UniqueFd stranger = connection_to(server_->endpoint());
    std::string greeting(64, '\0');
    greeting.replace(0, 1, "\xff").replace(9, 2, "\x7f\x03").replace(12, 4, "NULL");
    say(stranger, greeting);
    ASSERT_TRUE(is_refused());
    EXPECT_TRUE(
        eventually([] { return lines_with("keyless", "connected without a key").size() == 1; }));
}

TEST_F(StrangerWatchTest, ReportsAForgedHandshake) {
    serve("forged");
    const zmq::socket_t stranger = peer(host_, generate_curve_keys().public_key);
    ASSERT_TRUE(is_refused());
    EXPECT_TRUE(eventually(
        [] { return lines_with("forged", "does not have this rig's public key").size() == 1; }));
}

TEST_F(StrangerWatchTest, CountsAnUnlistedKeyWithoutALineOfItsOwn) {
    serve("unlisted");
    const zmq::socket_t stranger = peer(generate_curve_keys(), server_->public_key());
    ASSERT_TRUE(is_refused());
    EXPECT_TRUE(lines_with("unlisted", "").empty());
}

TEST_F(StrangerWatchTest, DoesNotReportHosts) {
    serve("hosts");
    HostMessage message;
    message.host_id = 7;
    const std::vector<std::byte> word = encode(message);
    for (int i = 0; i < 20; ++i) {
        zmq::socket_t host = peer(host_, server_->public_key());
        // One of two leaves without a word.
        if (i % 2 == 0) continue;
        host.send(zmq::buffer(word), zmq::send_flags::none);
        zmq::message_t welcome;
        ASSERT_TRUE(host.recv(welcome));
    }
    EXPECT_TRUE(lines_with("hosts", "does not speak Vantage's protocol").empty());
    EXPECT_TRUE(lines_with("hosts", "key").empty());
}

TEST_F(StrangerWatchTest, LimitsTheLinesAboutUnlistedKeys) {
    serve("crowd");
    for (int i = 0; i < 30; ++i) {
        const zmq::socket_t stranger = peer(generate_curve_keys(), server_->public_key());
        ASSERT_TRUE(eventually([&] { return server_->refused_connections() > unsigned(i); }));
    }
    const std::vector<std::string> lines = recent_log_lines();
    const auto named = std::count_if(lines.begin(), lines.end(), [&](const std::string& line) {
        return line.find("to admit it, add the key to " +
                         (folder_.path() / "hosts.keys").string()) != line.npos;
    });
    EXPECT_EQ(named, 8);
}

TEST(StrangerWatch, ReportsAFloodOncePerTenSeconds) {
    zmq::context_t context;
    zmq::socket_t socket(context, zmq::socket_type::router);
    socket.set(zmq::sockopt::linger, 0);
    StrangerWatch watch(context, socket, "flood");
    socket.bind("tcp://127.0.0.1:*");
    const std::string endpoint = socket.get(zmq::sockopt::last_endpoint);
    const MonotonicTime start = monotonic_from_ns(1'000'000'000);
    for (unsigned i = 1; i <= 200; ++i) {
        connection_to(endpoint);
        ASSERT_TRUE(eventually([&] {
            watch.look(start);
            return watch.refused() == i;
        }));
    }
    ASSERT_EQ(lines_with("flood", "").size(), 1u);
    EXPECT_EQ(lines_with("flood", "not from a host: 1;").size(), 1u);
    watch.look(start + 9s);
    EXPECT_EQ(lines_with("flood", "").size(), 1u);
    watch.look(start + 10s);
    EXPECT_EQ(lines_with("flood", "not from a host: 199;").size(), 1u);
    watch.look(start + 30s);
    EXPECT_EQ(lines_with("flood", "").size(), 2u);
}

TEST(StrangerWatch, EndsDuringAFlood) {
    for (int round = 0; round < 20; ++round) {
        zmq::context_t context;
        zmq::socket_t socket(context, zmq::socket_type::router);
        socket.set(zmq::sockopt::linger, 0);
        const StrangerWatch watch(context, socket, "end");
        socket.bind("tcp://127.0.0.1:*");
        const std::string endpoint = socket.get(zmq::sockopt::last_endpoint);
        // More events than ZeroMQ holds for a socket by itself, and nobody reads them.
        for (int i = 0; i < 100; ++i) connection_to(endpoint);
    }
}

}  // namespace
}  // namespace vantage

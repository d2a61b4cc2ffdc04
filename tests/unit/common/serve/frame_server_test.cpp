#include "common/serve/frame_server.h"

#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <zmq.hpp>

#include <gtest/gtest.h>
#include <sys/socket.h>

#include "common/base/files/atomic_file.h"
#include "common/base/files/unique_fd.h"
#include "common/base/time/kernel_clock.h"
#include "common/config/socket_address.h"
#include "common/wire/curve_keys.h"
#include "common/wire/link_message.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"

namespace vantage {
namespace {

/// A host that grants a frame and reads none of it: most of it stays at the rig.
class StuckHost {
  public:
    StuckHost(const std::string& endpoint, std::uint64_t id, std::optional<int> tai_offset_s = {})
        : socket_(context_, zmq::socket_type::dealer) {
        socket_.set(zmq::sockopt::linger, 0);
        socket_.set(zmq::sockopt::rcvhwm, 1);
        socket_.set(zmq::sockopt::rcvbuf, 4096);
        socket_.connect(endpoint);
        request_.host_id = id;
        request_.tai_offset_s = tai_offset_s;
        say();
        zmq::message_t welcome;
        EXPECT_TRUE(socket_.recv(welcome));
        request_.link = decode_rig_message({welcome.data<std::byte>(), welcome.size()}).link;
        say();
    }

  private:
    void say() { socket_.send(zmq::buffer(encode(request_)), zmq::send_flags::none); }

    zmq::context_t context_;
    zmq::socket_t socket_;
    HostMessage request_;
};

TEST(FrameServer, NamesAHostWithAnotherTaiOffset) {
    FrameServer::Settings settings;
    settings.bind = "tcp://127.0.0.1:*";
    const FrameServer server(settings, "rig-a", 42);
    testing::internal::CaptureStderr();
    const StuckHost host(server.endpoint(), 1, read_kernel_clock().tai_offset_s + 37);
    const std::string log = testing::internal::GetCapturedStderr();
    EXPECT_NE(log.find("differ by 37 s"), std::string::npos) << log;
    EXPECT_EQ(log.find("differ by", log.find("differ by") + 1), std::string::npos)
        << "it is said once";
}

TEST(FrameServer, OfAnyAddressIsReachedOverBothFamilies) {
    FrameServer::Settings settings;
    settings.bind = "tcp://*:*";
    TemporaryFolder folder;
    const CurveKeys keys = generate_curve_keys();
    settings.key_file = folder.path() / "rig.key";
    write_key_file(settings.key_file, keys);
    settings.authorized_hosts = folder.path() / "hosts.keys";
    write_text_atomically(settings.authorized_hosts, keys.public_key + "\n");
    const FrameServer server(settings, "rig-a", 42);
    const int port = std::stoi(server.endpoint().substr(server.endpoint().rfind(':') + 1));
    for (const char* host : {"127.0.0.1", "::1"}) {
        const SocketAddress address = resolve_all(host, port).front();
        const UniqueFd fd(::socket(address.family(), SOCK_STREAM | SOCK_CLOEXEC, 0));
        if (!fd) continue;  // no IPv6 here
        EXPECT_EQ(::connect(fd.get(), address.get(), address.size), 0) << host;
    }
}

/// A host that the rig has admitted. It says what it is told to, and hears one message at a time.
class TalkingHost {
  public:
    TalkingHost(const std::string& endpoint, const CurveKeys& keys, const std::string& rig_key)
        : socket_(context_, zmq::socket_type::dealer) {
        constexpr int patience_ms = 60'000;
        socket_.set(zmq::sockopt::linger, 0);
        socket_.set(zmq::sockopt::rcvtimeo, patience_ms);
        socket_.set(zmq::sockopt::curve_serverkey, rig_key);
        socket_.set(zmq::sockopt::curve_publickey, keys.public_key);
        socket_.set(zmq::sockopt::curve_secretkey, keys.secret_key);
        zmq::socket_t events(context_, zmq::socket_type::pair);
        zmq_socket_monitor(socket_.handle(), "inproc://admission", ZMQ_EVENT_HANDSHAKE_SUCCEEDED);
        events.set(zmq::sockopt::linger, 0);
        events.connect("inproc://admission");
        socket_.connect(endpoint);
        zmq::message_t event;
        EXPECT_TRUE(events.recv(event)) << "the rig admits this host";
        zmq_socket_monitor(socket_.handle(), nullptr, 0);
    }
    /// Speaks until the answer is, or is not, a refusal. Returns the refusal.
    std::string speak_until(bool is_refused) {
        HostMessage request;
        request.host_id = 1;
        while (true) {
            socket_.send(zmq::buffer(encode(request)), zmq::send_flags::none);
            zmq::message_t answer;
            EXPECT_TRUE(socket_.recv(answer));
            const RigMessage message =
                decode_rig_message({answer.data<std::byte>(), answer.size()});
            if (message.refusal.empty() != is_refused) return message.refusal;
        }
    }

    /// Speaks on, whatever the answers are, until the connection is ended; false if it never is.
    bool is_cut_off() {
        zmq::socket_t events(context_, zmq::socket_type::pair);
        zmq_socket_monitor(socket_.handle(), "inproc://events", ZMQ_EVENT_DISCONNECTED);
        events.set(zmq::sockopt::linger, 0);
        events.connect("inproc://events");
        const bool is_cut = eventually([&] {
            socket_.send(zmq::buffer(encode(HostMessage{.host_id = 1})), zmq::send_flags::dontwait);
            zmq::message_t event;
            return events.recv(event, zmq::recv_flags::dontwait).has_value();
        });
        zmq_socket_monitor(socket_.handle(), nullptr, 0);
        return is_cut;
    }

  private:
    zmq::context_t context_;
    zmq::socket_t socket_;
};

TEST(FrameServer, StopsServingAConnectedHostWhoseKeyIsRemoved) {
    const TemporaryFolder folder;
    const CurveKeys rig = generate_curve_keys(), first = generate_curve_keys(),
                    second = generate_curve_keys();
    FrameServer::Settings settings;
    settings.bind = "tcp://127.0.0.1:*";
    settings.key_file = folder.path() / "rig.key";
    settings.authorized_hosts = folder.path() / "hosts.keys";
    write_key_file(settings.key_file, rig);
    const auto list = [&](const std::string& text) {
        write_text_atomically(settings.authorized_hosts, text);
        // A file system may keep times too coarse for two changes at once.
        static int changes = 0;
        std::filesystem::last_write_time(
            settings.authorized_hosts,
            std::filesystem::file_time_type::clock::now() + std::chrono::seconds(++changes));
    };
    list(first.public_key + "\n" + second.public_key + "\n");
    FrameServer server(settings, "rig-a", 42);
    TalkingHost removed(server.endpoint(), first, rig.public_key),
        silent(server.endpoint(), first, rig.public_key),
        kept(server.endpoint(), second, rig.public_key);
    removed.speak_until(false);
    kept.speak_until(false);
    list(second.public_key + "\n");
    EXPECT_NE(removed.speak_until(true).find("rig rig-a no longer admits this host"),
              std::string::npos);
    EXPECT_NE(silent.speak_until(true).find("rig rig-a no longer admits this host"),
              std::string::npos)
        << "it had not spoken before";
    EXPECT_TRUE(silent.is_cut_off());
    kept.speak_until(false);
    EXPECT_EQ(server.change([](HostLinks& links) {
        std::size_t attached = 0;
        for (const HostLinks::HostStatus& host : links.hosts()) attached += host.attached;
        return attached;
    }),
              1u);
    list(first.public_key + "\n" + second.public_key + "\n");
    removed.speak_until(false);
    list(second.public_key + "\n");
    EXPECT_TRUE(removed.is_cut_off());
    kept.speak_until(false);
    list("");
    EXPECT_TRUE(kept.is_cut_off()) << "the list is empty now";
}

// ZeroMQ aborts the program (libzmq issue 3442) where a connection breaks at the moment at which
// the socket is closed without lingering, with a message half sent.
TEST(FrameServer, EndsWellWhileItsHostsLeaveWithFramesHalfSent) {
    constexpr int rounds = 60;
    constexpr std::size_t more_than_networks_hold = 8 << 20;
    auto frame = std::make_shared<PackedFrame>();
    frame->header.resize(100);
    frame->colour.resize(more_than_networks_hold);
    frame->disparity.resize(100);
    FrameServer::Settings settings;
    settings.bind = "tcp://127.0.0.1:*";
    for (int round = 0; round < rounds; ++round) {
        auto server = std::make_unique<FrameServer>(settings, "rig-a", 42);
        std::array hosts{std::make_unique<StuckHost>(server->endpoint(), 1),
                         std::make_unique<StuckHost>(server->endpoint(), 2)};
        server->tell([&](HostLinks& links) { links.offer(frame); });
        ASSERT_TRUE(eventually([&] {
            return server->change([](HostLinks& links) {
                const auto all = links.hosts();
                return all.size() == 2 && all[0].counters.sent + all[1].counters.sent == 2;
            });
        }));
        std::atomic<bool> ends = false;
        std::thread leaving([&] {
            while (!ends) {
            }
            for (auto& host : hosts) host.reset();
        });
        ends = true;
        server.reset();
        leaving.join();
    }
}

}  // namespace
}  // namespace vantage

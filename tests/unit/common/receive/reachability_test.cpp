#include "common/receive/reachability.h"

#include <string>
#include <zmq.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/socket_address.h"
#include "tests/support/free_ports.h"
#include "tests/support/two_addresses.h"

namespace vantage {
namespace {

using testing::HasSubstr;

constexpr std::chrono::milliseconds limit{1000};

std::string why(const std::string& endpoint) {
    return reach(parse_endpoint(endpoint, "endpoint"), limit).reason;
}

TEST(Reachability, ReportsNothingForAnOpenPort) {
    zmq::context_t context;
    zmq::socket_t listener(context, zmq::socket_type::router);
    listener.bind("tcp://127.0.0.1:*");
    EXPECT_EQ(why(listener.get(zmq::sockopt::last_endpoint)), "");
}

TEST(Reachability, TriesEveryAddressOfAName) {
    const int port = two_free_ports().first;
    const std::vector<SocketAddress> addresses = resolve_all("localhost", port);
    const Endpoint endpoint = parse_endpoint(fmt::format("tcp://localhost:{}", port), "endpoint");
    {
        // Only the last address of the name is listened on, until the context is closed.
        zmq::context_t context;
        zmq::socket_t listener(context, zmq::socket_type::router);
        listener.set(zmq::sockopt::ipv6, true);
        listener.bind("tcp://" + addresses.back().text());
        EXPECT_EQ(reach(endpoint, limit).address, "tcp://" + addresses.back().text());
    }
    for (const SocketAddress& address : addresses)
        EXPECT_THAT(reach(endpoint, limit).reason, HasSubstr(address.host()));
}

TEST(Reachability, ConnectsToTheAddressThatAnswers) {
    const int port = two_free_ports().first;
    zmq::context_t context;
    zmq::socket_t listener(context, zmq::socket_type::router);
    listener.bind(fmt::format("tcp://127.0.0.1:{}", port));
    const std::string endpoint = fmt::format("tcp://{}:{}", name_of_two_addresses, port);
    EXPECT_EQ(reach(parse_endpoint(endpoint, "endpoint"), limit).address,
              fmt::format("tcp://127.0.0.1:{}", port))
        << "[::1] comes first, and nobody listens there";
}

TEST(Reachability, NamesBothAddressesOfANameThatDoesNotAnswer) {
    const std::string reason =
        why(fmt::format("tcp://{}:{}", name_of_two_addresses, two_free_ports().first));
    EXPECT_THAT(reason, HasSubstr("[::1]"));
    EXPECT_THAT(reason, HasSubstr("127.0.0.1"));
}

TEST(Reachability, ReportsAClosedPort) {
    const std::string endpoint = "tcp://127.0.0.1:" + std::to_string(two_free_ports().first);
    EXPECT_THAT(why(endpoint), HasSubstr("connection refused at " + endpoint));
}

TEST(Reachability, ReportsANameThatDoesNotResolve) {
    EXPECT_THAT(why("tcp://no-such-rig.invalid:5600"),
                HasSubstr("the name no-such-rig.invalid does not resolve"));
}

}  // namespace
}  // namespace vantage

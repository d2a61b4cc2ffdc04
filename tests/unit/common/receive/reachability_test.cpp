#include "common/receive/reachability.h"

#include <string>
#include <zmq.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/free_ports.h"

namespace vantage {
namespace {

using testing::HasSubstr;

constexpr std::chrono::milliseconds limit{1000};

std::string why(const std::string& endpoint) {
    return why_unreachable(parse_endpoint(endpoint, "endpoint"), limit);
}

TEST(Reachability, ReportsNothingForAnOpenPort) {
    zmq::context_t context;
    zmq::socket_t listener(context, zmq::socket_type::router);
    listener.bind("tcp://127.0.0.1:*");
    EXPECT_EQ(why(listener.get(zmq::sockopt::last_endpoint)), "");
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

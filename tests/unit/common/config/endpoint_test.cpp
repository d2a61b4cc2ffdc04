#include "common/config/endpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"

namespace vantage {
namespace {

TEST(Endpoint, RecognisesLoopbackAddresses) {
    for (const char* text : {"tcp://127.0.0.1:5600", "tcp://127.9.8.7:1", "tcp://localhost:5600",
                             "tcp://[::1]:5600", "tcp://127.0.0.1:*"})
        EXPECT_TRUE(parse_endpoint(text, "bind").loopback) << text;
    for (const char* text : {"tcp://0.0.0.0:5600", "tcp://*:5600", "tcp://10.0.0.1:5600",
                             "tcp://rig-a.local:5600", "tcp://[fe80::1]:5600", "tcp://eth0:5600",
                             "tcp://127.evil.example:5600", "tcp://localhost.evil.example:5600"})
        EXPECT_FALSE(parse_endpoint(text, "bind").loopback) << text;
}

TEST(Endpoint, RoundTripsItsText) {
    for (const char* text : {"tcp://127.0.0.1:5600", "tcp://[::1]:65535", "tcp://*:*"})
        EXPECT_EQ(parse_endpoint(text, "bind").text(), text);
}

TEST(Endpoint, RefusesInvalidEndpointsAndNamesTheKey) {
    for (const char* text :
         {"", "tcp://", "tcp://127.0.0.1", "127.0.0.1:5600", "udp://127.0.0.1:5600", "tcp://:5600",
          "tcp://127.0.0.1:", "tcp://127.0.0.1:0", "tcp://127.0.0.1:65536", "tcp://127.0.0.1:56x",
          "tcp://127.0.0.1:-1", "tcp://127.0.0.1:0;10.0.0.1:5600", "tcp://[::zz]:5600",
          "tcp://[::1:5600", "ipc:///tmp/x", "tcp://a b:5600"})
        try {
            parse_endpoint(text, "stream.bind");
            ADD_FAILURE() << text;
        } catch (const Error& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr("stream.bind"));
        }
}

}  // namespace
}  // namespace vantage

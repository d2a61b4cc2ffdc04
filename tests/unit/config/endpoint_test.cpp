#include "common/config/endpoint.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

TEST(Endpoint, TakesWhatASocketTakes) {
    EXPECT_EQ(endpoint_fault("tcp://127.0.0.1:5600", EndpointUse::bind), "");
    EXPECT_EQ(endpoint_fault("tcp://[::1]:65535", EndpointUse::connect), "");
    EXPECT_EQ(endpoint_fault("tcp://*:5600", EndpointUse::bind), "");
    EXPECT_EQ(endpoint_fault("tcp://127.0.0.1:*", EndpointUse::bind), "");
    EXPECT_EQ(endpoint_fault("ipc:///tmp/rig", EndpointUse::connect), "");
}

TEST(Endpoint, RefusesTheRest) {
    for (const char* endpoint :
         {"", "127.0.0.1:5600", "udp://127.0.0.1:5600", "tcp://127.0.0.1", "tcp://:5600",
          "tcp://host:0", "tcp://host:65536", "tcp://host:", "tcp://host:56x", "ipc://"})
        EXPECT_NE(endpoint_fault(endpoint, EndpointUse::bind), "") << endpoint;
    EXPECT_NE(endpoint_fault("tcp://host:*", EndpointUse::connect), "");
}

TEST(Z85Key, HasFortyCharactersOfTheAlphabet) {
    const std::string good = "rq:rM>}U?@Lns47E1%kR.o@n%FcmmsL/@{H8]yf7";
    EXPECT_EQ(z85_key_fault(good), "");
    EXPECT_NE(z85_key_fault(good.substr(1)), "");
    EXPECT_NE(z85_key_fault(good + "a"), "");
    std::string strange = good;
    strange[3] = '"';
    EXPECT_NE(z85_key_fault(strange), "");
}

}  // namespace
}  // namespace vantage

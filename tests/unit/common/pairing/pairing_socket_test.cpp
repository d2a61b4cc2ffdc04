#include "rig_firmware/pairing/pairing_socket.h"

#include <thread>

#include <gtest/gtest.h>

#include "host_app/setup/pairing_call.h"
#include "tests/support/eventually.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

/// A rig that is open for pairing, and whoever calls it, over sockets of loopback.
struct PairingSocketTest : testing::Test {
    static PairOffer offer() {
        PairOffer north;
        north.rig = "north";
        return north;
    }
    PairingSocket socket{"tcp://127.0.0.1:*"};
    CurveKeys rig_keys = generate_curve_keys(), host_keys = generate_curve_keys();
    PairingWindow window{rig_keys, offer(), {}, MonotonicClock::now()};

    /// Runs both ends until the condition is true.
    template <class Condition>
    bool until(PairingCall& call, Condition condition) {
        return eventually([&] {
            socket.serve(window, MonotonicClock::now());
            call.turn(MonotonicClock::now());
            return condition();
        });
    }
};

TEST_F(PairingSocketTest, CarriesAPairing) {
    PairingCall call(socket.endpoint(), host_keys, "gallery", {});
    ASSERT_TRUE(until(call, [&] { return window.to_compare() && call.to_compare(); }));
    EXPECT_EQ(window.to_compare()->code(), call.to_compare());
    call.confirm();
    EXPECT_FALSE(call.to_compare()) << "it is answered";
    socket.send(window.confirm());
    ASSERT_TRUE(until(call, [&] { return call.is_agreed() && window.paired(); }));
    EXPECT_EQ(window.paired()->public_key, host_keys.public_key);
    EXPECT_EQ(call.rig().public_key, rig_keys.public_key);
    EXPECT_EQ(socket.peer_address(), "127.0.0.1");
}

TEST_F(PairingSocketTest, IgnoresInvalidMessagesOfOthers) {
    PairingCall call(socket.endpoint(), host_keys, "gallery", {});
    zmq::context_t context;
    zmq::socket_t other(context, zmq::socket_type::dealer);
    other.connect(socket.endpoint());
    other.send(zmq::str_buffer("nonsense"));
    other.send(zmq::str_buffer("of two"), zmq::send_flags::sndmore);
    other.send(zmq::str_buffer("parts"));
    zmq::message_t refusal;
    ASSERT_TRUE(until(call, [&] { return window.to_compare() && call.to_compare(); }));
    for (int answers = 0; answers < 2;)
        if (until(call, [&] { return !!other.recv(refusal, zmq::recv_flags::dontwait); }))
            ++answers;
    EXPECT_TRUE(std::holds_alternative<PairRefusal>(
        decode_pair_message({refusal.data<std::byte>(), refusal.size()})));
    EXPECT_TRUE(window.to_compare());
    EXPECT_EQ(window.attempts_made(), 1);
}

TEST_F(PairingSocketTest, ReportsARigsRefusalToTheHost) {
    PairingCall call(socket.endpoint(), host_keys, "gallery", {});
    ASSERT_TRUE(until(call, [&] { return window.to_compare() && call.to_compare(); }));
    call.confirm();
    socket.send(window.reject(MonotonicClock::now()));
    EXPECT_NE(thrown_sentence([&] { until(call, [] { return false; }); }).find("the rig says"),
              std::string::npos);
    EXPECT_FALSE(call.is_agreed());
}

TEST_F(PairingSocketTest, LimitsTheWaitForTheProgram) {
    PairingCall silent(socket.endpoint(), host_keys, "gallery", {.answer_in = 1h});
    EXPECT_NE(
        thrown_sentence([&] { silent.turn(MonotonicClock::now() + 2h); }).find("nothing pairs at"),
        std::string::npos);
}

TEST_F(PairingSocketTest, LimitsTheWaitForThePerson) {
    PairingCall shown(socket.endpoint(), host_keys, "gallery", {});
    ASSERT_TRUE(until(shown, [&] { return shown.to_compare().has_value(); }));
    EXPECT_NE(
        thrown_sentence([&] { shown.turn(MonotonicClock::now() + 1h); }).find("not paired in time"),
        std::string::npos);
}

TEST_F(PairingSocketTest, ReportsAPortInUse) {
    EXPECT_NE(thrown_sentence([&] { PairingSocket another(socket.endpoint()); }).find("in use"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage

#include "common/receive/rig_link.h"

#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <vector>
#include <zmq_addon.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/wire/zmq_helpers.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// Far beyond what any of this takes; a test that waits so long has failed.
constexpr auto patience = 60s;

/// A rig of which the test moves every word, and the host's end of the link to it, on one thread.
class RigLinkTest : public testing::Test {
  protected:
    RigLinkTest() { listen("tcp://127.0.0.1:*"); }

    void listen(const std::string& endpoint) {
        rig_ = zmq::socket_t(context_, zmq::socket_type::router);
        rig_.set(zmq::sockopt::linger, 0);
        rig_.bind(endpoint);
    }

    void open_link() { link_.emplace(context_, StageConfig::Rig{"rig-a", endpoint(), ""}, keys_); }
    std::string endpoint() const { return rig_.get(zmq::sockopt::last_endpoint); }

    /// Lets the link work until `done`; false if that never comes.
    bool until(const std::function<bool()>& done) {
        const MonotonicTime end = MonotonicClock::now() + patience;
        while (MonotonicClock::now() < end) {
            if (done()) return true;
            std::vector<zmq::pollitem_t> items{{link_->socket().handle(), 0, ZMQ_POLLIN, 0},
                                               {link_->monitor().handle(), 0, ZMQ_POLLIN, 0},
                                               {rig_.handle(), 0, ZMQ_POLLIN, 0}};
            wait_for(items, 5ms);
            const MonotonicTime now = MonotonicClock::now();
            link_->watch(now);
            if (link_->receive(now)) ++deliveries_;
            link_->tick(request_, now);
            hear();
        }
        return false;
    }

    void hear() {
        std::vector<zmq::message_t> parts;
        while (zmq::recv_multipart(rig_, std::back_inserter(parts), zmq::recv_flags::dontwait)) {
            route_ = parts.at(0).to_string();
            heard_ = decode_host_message(bytes_of(parts.at(1)));
            parts.clear();
        }
    }

    /// As the rig: a heartbeat, or with a frame.
    void say(std::uint64_t link, std::uint64_t sent, bool with_frame) {
        RigMessage message;
        message.rig = "rig-a";
        message.session = link;
        message.link = link;
        message.counters.sent = message.counters.offered = sent;
        say(message, with_frame);
    }
    void say(const RigMessage& message, bool with_frame = false) {
        const std::vector<std::byte> bytes = encode(message);
        rig_.send(zmq::buffer(route_), zmq::send_flags::sndmore);
        rig_.send(zmq::buffer(bytes),
                  with_frame ? zmq::send_flags::sndmore : zmq::send_flags::none);
        if (!with_frame) return;
        rig_.send(zmq::str_buffer("header"), zmq::send_flags::sndmore);
        rig_.send(zmq::str_buffer("colour"), zmq::send_flags::sndmore);
        rig_.send(zmq::str_buffer("disparity"), zmq::send_flags::none);
    }

    RigLink::View view() { return link_->view(MonotonicClock::now()); }
    bool connected() { return view().connected; }

    void connect(std::uint64_t link) {
        open_link();
        ASSERT_TRUE(until([&] { return heard_.has_value(); }));
        say(link, 0, false);
        ASSERT_TRUE(until([&] { return connected(); }));
    }

    zmq::context_t context_;
    zmq::socket_t rig_;
    std::optional<CurveKeys> keys_;
    std::optional<RigLink> link_;
    RigLink::Request request_;
    int deliveries_ = 0;
    std::string route_;
    std::optional<HostMessage> heard_;
};

TEST_F(RigLinkTest, NeverReportsMoreHandledFramesThanCame) {
    connect(7);
    for (const std::uint64_t sent : {1, 2, 3}) say(7, sent, true);
    request_.unhandled = 3;
    ASSERT_TRUE(until([&] { return deliveries_ == 3 && heard_->link == 7; }));
    // The rig's daemon is started anew; what it sent before is still being decoded.
    say(8, 1, true);
    request_.unhandled = 4;
    ASSERT_TRUE(until([&] { return heard_->link == 8; }));
    EXPECT_EQ(heard_->handled, 0u);
    request_.unhandled = 0;
    ASSERT_TRUE(until([&] { return heard_->handled == 1; }));
}

TEST_F(RigLinkTest, ABrokenConnectionDisconnectsTheRigAtOnce) {
    connect(7);
    const std::string place = endpoint();
    rig_.close();
    const MonotonicTime start = MonotonicClock::now();
    std::vector<zmq::pollitem_t> items{{link_->monitor().handle(), 0, ZMQ_POLLIN, 0}};
    while (!view().last_error.starts_with("the connection") &&
           MonotonicClock::now() - start < patience) {
        wait_for(items, 5ms);
        link_->watch(MonotonicClock::now());
    }
    // Asked about the moment it was last heard: not by its silence.
    EXPECT_FALSE(link_->view(start).connected);
    listen(place);
    heard_.reset();
    ASSERT_TRUE(until([&] { return heard_.has_value(); }));
    say(8, 0, false);
    EXPECT_TRUE(until([&] { return connected(); }));
}

TEST_F(RigLinkTest, ConnectsToAnotherAddressOfTheRigsName) {
    const std::string answering = endpoint();
    const std::string port = answering.substr(answering.rfind(':'));
    link_.emplace(context_, StageConfig::Rig{"rig-a", "tcp://127.0.0.77" + port, ""}, keys_);
    link_->use_address(answering);
    ASSERT_TRUE(until([&] { return heard_.has_value(); }));
    EXPECT_TRUE(heard_->tai_offset_s);
}

TEST_F(RigLinkTest, ARefusalDisconnectsTheRigAtOnce) {
    connect(7);
    const MonotonicTime start = MonotonicClock::now();
    RigMessage refusal;
    refusal.rig = "rig-a";
    refusal.refusal = "no more hosts";
    say(refusal);
    ASSERT_TRUE(until([&] { return !view().refused.empty(); }));
    EXPECT_FALSE(link_->view(start).connected);
    EXPECT_EQ(view().refused, "no more hosts");
}

TEST_F(RigLinkTest, CountsInvalidMessages) {
    connect(7);
    rig_.send(zmq::buffer(route_), zmq::send_flags::sndmore);
    rig_.send(zmq::str_buffer("\x12\x02\xff\xfe"), zmq::send_flags::none);
    testing::internal::CaptureStderr();
    EXPECT_TRUE(until([&] { return view().malformed == 1; }));
    EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("refused input of rig message"))
        << "for bug reports; the receiver reports the fault";
    EXPECT_THAT(view().last_error, HasSubstr("truncated or damaged"));
}

}  // namespace
}  // namespace vantage

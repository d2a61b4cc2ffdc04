#include <cstdlib>
#include <set>

#include "host_app/control/ports/messages/osc_message.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/flight/given_commands.h"
#include "tests/unit/host_app/ports/bench_test.h"

namespace vantage {
namespace {

class OscPortTest : public BenchTest {
  protected:
    /// With oscsend, as anybody would.
    void oscsend(const std::string& words) {
        const std::string line = fmt::format("oscsend 127.0.0.1 {} {}", number_, words);
        ASSERT_EQ(std::system(line.c_str()), 0) << line;
    }
    std::unique_ptr<ControlPort> port_ = open("osc");
};

TEST_F(OscPortTest, ObeysWhatOscsendSends) {
    oscsend("/vantage/shot i 3");
    oscsend("/vantage/orbit f 5.0");
    oscsend("/vantage/mark_in");
    oscsend("/vantage/freeze f 1.0");
    oscsend("/vantage/freeze f 0.0");
    oscsend("/vantage/output/2 i 1");
    serve(*port_, 6);
    EXPECT_EQ(port_->stats().obeyed, 6u) << port_->stats().last_refusal;
    const FlightInput input = operator_input_.take().input;
    EXPECT_EQ(number_of<command::RecallShot>(input), 3);
    EXPECT_NEAR(input.orbit_azimuth_rad, 5 * 3.14159265 / 180, 1e-6);
    EXPECT_TRUE(input.find<command::MarkIn>());
    EXPECT_TRUE(input.find<command::ToggleHold>()) << "once: 0 is the button that is let go";
    EXPECT_EQ(number_of<command::ToggleOutput>(input), 2);
}

TEST_F(OscPortTest, TakesNumbersOfEveryKind) {
    for (const char* number : {"i 3", "h 3", "f 3.0", "d 3.0"}) {
        oscsend(fmt::format("/vantage/shot {}", number));
        serve(*port_, all(port_->stats()) + 1);
        EXPECT_EQ(number_of<command::RecallShot>(operator_input_.take().input), 3) << number;
    }
}

TEST_F(OscPortTest, ObeysOldNamesOfCommands) {
    oscsend("/vantage/learn_set");  // old name
    serve(*port_, 1);
    EXPECT_TRUE(operator_input_.take().input.find<command::LearnBackground>());
}

TEST_F(OscPortTest, TakesWordsWhereACommandHasThem) {
    oscsend("/vantage/cue_time s 20:15:07:12");
    serve(*port_, 1);
    EXPECT_EQ(operator_input_.take().input.find<command::CueTime>()->time, "20:15:07:12");
    oscsend("/vantage/name_clip s leap");
    oscsend("/vantage/clip i 12");
    serve(*port_, 3);
    const std::vector<ReplayCall> calls = replay_calls(operator_input_.take().input);
    ASSERT_EQ(calls.size(), 2u);
    EXPECT_EQ(calls[0].words, "leap");
    EXPECT_EQ(calls[1].number, 12);
    for (const char* wrong : {"/vantage/name_clip", "/vantage/name_clip i 3",
                              "/vantage/name_clip ss a b", "/vantage/live s now"})
        oscsend(wrong);
    serve(*port_, 7);
    EXPECT_EQ(port_->stats().malformed, 4u);
}

TEST_F(OscPortTest, CountsAndNeverObeysWhatDoesNotFit) {
    oscsend("/vantage/shot i 10");
    oscsend("/vantage/shot s three");
    oscsend("/vantage/orbit f 1000.0");
    oscsend("/vantage/live iii 1 2 3");
    oscsend("/vantage/no_such i 1");
    oscsend("/other/live");
    peer_.send("no OSC at all", number_);
    peer_.send(std::string_view("#bundle\0\0\0\0\0\0\0\0\1\0\0\1\0live", 24), number_);
    serve(*port_, 8);
    EXPECT_EQ(port_->stats().malformed, 6u);
    EXPECT_EQ(port_->stats().unknown, 2u);
    EXPECT_EQ(port_->stats().obeyed, 0u);
    EXPECT_FALSE(operator_input_.take().since) << "nothing of it was done";
}

TEST_F(OscPortTest, OfAFloodCommandsBeyondTheBoundAreCountedAndLeftOut) {
    const std::string freeze("/vantage/freeze\0,\0\0\0", 20);
    constexpr std::uint64_t flood = 5000;
    for (std::uint64_t i = 0; i < flood; ++i) {
        peer_.send(freeze, number_);
        if (i % 20 == 0) port_->serve(std::chrono::milliseconds(0));
    }
    peer_.send(freeze, number_);
    serve(*port_, flood + 1);
    const PortStats& stats = port_->stats();
    EXPECT_EQ(stats.obeyed + stats.dropped, flood + 1);
    EXPECT_EQ(stats.obeyed, OperatorInputBox::max_commands) << "no more wait than that";
}

TEST_F(OscPortTest, TellsLampsToWhoSubscribesAndAgainWhenTheyChange) {
    ShowLamps show;
    show.live = true;
    show.coverage = 0.5;
    lamps_.put(show);
    const std::string subscribe("/vantage/subscribe\0\0,\0\0\0", 24);
    peer_.send(subscribe, number_);
    serve(*port_, 1);
    std::set<std::string> told;
    for (const Lamp& lamp : lamps())
        for (const std::string_view name : {lamp.name, lamp.old_name})
            if (!name.empty()) told.insert(peer_.receive());
    const auto message = [](const std::string& name, const LampValue& value) {
        const std::vector<std::byte> bytes = encode_osc("/vantage/lamp/" + name, value);
        return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    };
    EXPECT_TRUE(told.contains(message("live", true)));
    EXPECT_TRUE(told.contains(message("coverage", 0.5)));
    EXPECT_TRUE(told.contains(message("synthesiser", "")));
    EXPECT_TRUE(told.contains(message("background", -1.0)));
    EXPECT_TRUE(told.contains(message("set", -1.0))) << "the old name is still sent";
    show.live = false;
    lamps_.put(show);
    std::string next;
    for (int i = 0; i < 100 && next.empty(); ++i) {
        port_->serve(std::chrono::milliseconds(20));
        next = peer_.receive();
    }
    EXPECT_EQ(next, message("live", false)) << "what did not change is not told";
}

TEST_F(OscPortTest, TakesBundlesApart) {
    const std::string live("\0\0\0\x14/vantage/live\0\0\0,\0\0\0", 24);
    const std::string cue("\0\0\0\x14/vantage/cue\0\0\0\0,\0\0\0", 24);
    peer_.send(std::string("#bundle\0\0\0\0\0\0\0\0\1", 16) + live + cue, number_);
    serve(*port_, 2);
    EXPECT_EQ(port_->stats().obeyed, 2u) << port_->stats().last_refusal;
    const FlightInput input = operator_input_.take().input;
    EXPECT_TRUE(input.find<command::ToLive>() && input.find<command::CueIn>());
}

TEST_F(BenchTest, NothingListensBeyondThisComputerUnlessTheUrlSaysSo) {
    const auto opened = [&](const std::string& url) {
        return thrown_sentence([&] { open_port(url, bench_); });
    };
    const std::string beyond = fmt::format("osc://0.0.0.0:{}", number_);
    EXPECT_NE(opened(beyond).find("say open=yes"), std::string::npos) << opened(beyond);
    EXPECT_EQ(opened(beyond + "?open=yes"), "");
    EXPECT_EQ(opened(fmt::format("osc://:{}", number_)), "");
    EXPECT_NE(opened("oscc://:9000").find("osc"), std::string::npos);
    EXPECT_NE(opened("osc://:9000?opne=yes").find("open"), std::string::npos);
    EXPECT_NE(opened("osc://127.0.0.1").find("names no place"), std::string::npos);
    const auto taken = open("osc");
    EXPECT_NE(opened(fmt::format("osc://:{}", number_)).find("choose another"), std::string::npos);
}

}  // namespace
}  // namespace vantage

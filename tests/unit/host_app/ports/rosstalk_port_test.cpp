#include <fstream>

#include "host_app/control/ports/messages/rosstalk.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/flight/given_commands.h"
#include "tests/unit/host_app/ports/bench_test.h"
#include "tests/unit/host_app/ports/local_caller.h"

namespace vantage {
namespace {

TEST(RossTalkLine, HasANumberOrDestinationAndSource) {
    using Kind = RossTalkOrder::Kind;
    EXPECT_EQ(parse_rosstalk("GPI 12").order, (RossTalkOrder{Kind::gpi, 12, 0}));
    EXPECT_EQ(parse_rosstalk("GPI 12 ").order, (RossTalkOrder{Kind::gpi, 12, 0}))
        << "some panels send a blank before the end of the line";
    EXPECT_EQ(parse_rosstalk("XPT 2:7").order, (RossTalkOrder{Kind::xpt, 2, 7}));
    for (const char* wrong : {"GPI x", "GPI -1", "GPI  1", "GPI 99999999999", "XPT 2", "XPT :2",
                              "XPT 1:", "XPT 1:2:3", "XPT 1;2"}) {
        EXPECT_FALSE(parse_rosstalk(wrong).order) << wrong;
        EXPECT_TRUE(parse_rosstalk(wrong).is_known) << wrong;
    }
    for (const char* other : {"", "gpi 1", "Gpi 1", "GPI", "GPI ", "MEM 3", "FTB"})
        EXPECT_FALSE(parse_rosstalk(other).is_known) << other;
}

TEST(LineSplitter, EndsLinesAsAnySenderDoes) {
    LineSplitter lines;
    lines.take("GPI 1\r\nGP");
    EXPECT_EQ(lines.next(), "GPI 1");
    EXPECT_FALSE(lines.next());
    lines.take("I 2\nGPI 3\r");
    EXPECT_EQ(lines.next(), "GPI 2");
    EXPECT_EQ(lines.next(), "GPI 3");
    lines.take("\n\n");
    EXPECT_FALSE(lines.next()) << "an empty line is none";
    EXPECT_EQ(lines.rest(), "");
    lines.take(std::string(LineSplitter::most_line_bytes + 1, 'x'));
    EXPECT_TRUE(lines.is_flooded());
}

TEST(RossTalkMap, IsReadStrictly) {
    const auto refusal = [](const std::string& text) {
        return thrown_sentence(
            [&] { (void)RossTalkMap::read("version = 1\n" + text, "map.toml"); });
    };
    EXPECT_EQ(refusal("[gpi]\n1 = \"live\"\n[xpt]\n\"1:2\" = \"shot 2\"\n"), "");
    EXPECT_NE(refusal("[gpi]\none = \"live\"\n").find("number of a GPI"), std::string::npos);
    EXPECT_NE(refusal("[gpi]\n1 = \"lve\"\n").find("'live'"), std::string::npos);
    EXPECT_NE(refusal("[gpi]\n1 = \"orbit 3\"\n").find("must not be"), std::string::npos);
    EXPECT_NE(refusal("[xpt]\n12 = \"live\"\n").find("1:3"), std::string::npos);
    EXPECT_NE(refusal("[cc]\n1 = \"live\"\n").find("cc"), std::string::npos);
    const RossTalkMap standard = RossTalkMap::load({});
    EXPECT_STREQ(standard.find({RossTalkOrder::Kind::gpi, 1, 0})->command->name, "live");
    EXPECT_EQ(standard.find({RossTalkOrder::Kind::xpt, 2, 5})->argument, 5);
    EXPECT_EQ(standard.find({RossTalkOrder::Kind::gpi, 999, 0}), nullptr);
}

TEST_F(BenchTest, RossTalkGivesTheCommandsOfItsMap) {
    const TemporaryFolder folder;
    const std::string map = (folder.path() / "map.toml").string();
    std::ofstream(map) << "version = 1\n[gpi]\n4 = \"shot 7\"\n";
    const auto port = open("rosstalk", "?map=" + map);
    const LocalCaller caller(number_);
    caller.say("GPI 4\r\n");
    serve(*port, 1);
    EXPECT_EQ(port->stats().obeyed, 1u) << port->stats().last_refusal;
    EXPECT_EQ(number_of<command::RecallShot>(operator_input_.take().input), 7);
}

TEST_F(BenchTest, RossTalkCountsWhatDoesNotFitAndNeverObeysIt) {
    const auto port = open("rosstalk");
    const LocalCaller caller(number_);
    caller.say("gpi 1\r\nGPI one\r\nGPI 999\r\nGPI 1 XPT 1:\r\n\x1b[2J\r\n");
    serve(*port, 5);
    EXPECT_EQ(port->stats().unknown, 3u);
    EXPECT_EQ(port->stats().malformed, 2u);
    EXPECT_EQ(port->stats().obeyed, 0u);
    EXPECT_EQ(port->stats().last_refusal.find('\x1b'), std::string::npos);
    EXPECT_FALSE(operator_input_.take().since);
}

TEST_F(BenchTest, RossTalkObeysLinesThatEndWithALineFeedAndCountsWhatIsLeft) {
    const auto port = open("rosstalk");
    {
        const LocalCaller caller(number_);
        caller.say("GPI 2\nGPI 1");
        serve(*port, 1);
        EXPECT_TRUE(operator_input_.take().input.find<command::ToggleHold>());
    }
    serve(*port, 2);
    EXPECT_EQ(port->stats().obeyed, 1u);
    EXPECT_EQ(port->stats().malformed, 1u) << "its connection was closed in the middle of a line";
    EXPECT_NE(port->stats().last_refusal.find("'GPI 1'"), std::string::npos);
}

TEST_F(BenchTest, RossTalkClosesWhoSendsNoEndAndHearsTheOthers) {
    const auto port = open("rosstalk");
    const LocalCaller flood(number_), other(number_);
    flood.say(std::string(100'000, 'x'));
    other.say("GPI 2\r\n");
    serve(*port, 2);
    EXPECT_EQ(port->stats().malformed, 1u);
    EXPECT_EQ(port->stats().obeyed, 1u);
    EXPECT_TRUE(operator_input_.take().input.find<command::ToggleHold>());
    std::vector<std::unique_ptr<LocalCaller>> many;
    for (int i = 0; i < 12; ++i) {
        many.push_back(std::make_unique<LocalCaller>(number_));
        port->serve(std::chrono::milliseconds(0));
    }
    serve(*port, all(port->stats()) + 1);
    EXPECT_GE(port->stats().dropped, 1u) << "who is one too many is turned away and counted";
}

TEST_F(BenchTest, RossTalkListensHereOnlyUnlessItIsOpen) {
    const auto opened = [&](const std::string& url) {
        return thrown_sentence([&] { (void)open_port(url, bench_); });
    };
    EXPECT_NE(opened(fmt::format("rosstalk://0.0.0.0:{}", number_)).find("open=yes"),
              std::string::npos);
    EXPECT_NE(opened("rosstalk://0.0.0.0").find("open=yes"), std::string::npos);
    const auto taken = open("rosstalk");
    EXPECT_NE(opened(fmt::format("rosstalk://:{}", number_)).find("choose another"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage

#include <algorithm>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <pwd.h>
#include <unistd.h>

#include "rig_firmware/trigger/edge_watcher.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// gpio-sim's chip "vantage-test": line 0 TRIGGER is wired to line 1 TRIGGER_SEEN; line 2 HELD is
/// held by somebody else.
class TriggerLine : public testing::Test {
  protected:
    static RigConfig::Trigger seen_line() {
        RigConfig::Trigger trigger;
        trigger.chip = "vantage-test";
        trigger.line = "TRIGGER_SEEN";
        return trigger;
    }

    /// `vantage-rig trigger` with this line of [trigger].
    ProgramResult send(const std::string& line, int count) {
        const std::string config = (folder_.path() / "rig.toml").string();
        std::ofstream(config) << "version = 1\nname = \"rig\"\n[source]\nrate_hz = 5\n"
                              << "[trigger]\nrole = \"lead\"\nchip = \"vantage-test\"\n"
                              << line << "\nsensor = \"imx296\"\nexposure_us = 80000\n"
                              << "late_limit_us = 50000\n";
        return run_to_end(VANTAGE_RIG_PROGRAM, {"trigger", "--config", config, "--count",
                                                std::to_string(count), "--json"});
    }

    TemporaryFolder folder_;
};

TEST_F(TriggerLine, CarriesEveryPulseOnTheGridWithItsWidth) {
    EdgeWatcher watcher(seen_line());
    std::vector<EdgeWatcher::Edge> edges;
    std::jthread reader([&](const std::stop_token& stop) {
        while (!stop.stop_requested())
            if (const auto edge = watcher.next(100ms)) edges.push_back(*edge);
    });
    constexpr int count = 20;
    const ProgramResult result = send("line = \"TRIGGER\"", count);
    std::this_thread::sleep_for(300ms);
    reader.request_stop();
    reader.join();
    ASSERT_EQ(result.status, 0) << result.err;
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    std::printf("hil: trigger %s\n", summary.dump().c_str());
    const auto sent = summary["sent"].get<std::size_t>();
    // Wide pulses at a low rate: under emulation the kernel's handler of an edge may run
    // milliseconds late, and two edges within that time are one to it.
    EXPECT_EQ(sent + summary["skipped"].get<std::size_t>(), static_cast<std::size_t>(count));
    EXPECT_GE(sent, static_cast<std::size_t>(count * 3 / 4));
    // Taking the line as an output may itself give an edge to rest.
    while (!edges.empty() && !edges.front().leading) edges.erase(edges.begin());
    ASSERT_EQ(edges.size(), 2 * sent) << "an edge for the begin and the end of every pulse";
    constexpr std::chrono::nanoseconds width = 80ms - 14'260ns, period = 200ms;
    std::vector<std::chrono::nanoseconds> widths;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        EXPECT_EQ(edges[i].leading, i % 2 == 0) << i;
        EXPECT_EQ(edges[i].lost, 0u) << i;
        if (i == 0) continue;
        const std::chrono::nanoseconds apart = edges[i].time - edges[i - 1].time;
        if (i % 2 == 1) {
            EXPECT_GE(apart, width - 300us) << "the kernel stamps behind the write";
            widths.push_back(apart);
            continue;
        }
        // From one leading edge to the next: whole periods, up to the lateness of both.
        const std::chrono::nanoseconds between = edges[i].time - edges[i - 2].time;
        const auto periods = (between + period / 2) / period;
        EXPECT_GE(periods, 1) << i;
        EXPECT_LE(std::abs((between - periods * period).count()), 50'000'000) << i;
    }
    // A busy computer that is emulated ends some pulses late, and the best quarter on time.
    std::nth_element(widths.begin(), widths.begin() + count / 4, widths.end());
    std::printf("hil: a quarter of the pulses are at most %.3f ms wide\n",
                std::chrono::duration<double, std::milli>(widths[count / 4]).count());
    EXPECT_LT(widths[count / 4], width + 5ms);
}

TEST_F(TriggerLine, IsFoundByOffsetToo) {
    const ProgramResult result = send("line_offset = 0", 2);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("line 0 'TRIGGER' of 'vantage-test'"));
}

TEST_F(TriggerLine, SaysWhoHoldsIt) {
    const ProgramResult result = send("line = \"HELD\"", 2);
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err,
                HasSubstr("line 2 'HELD' of 'vantage-test' is held by 'somebody-else'"));
}

TEST_F(TriggerLine, ListsWhatThereIs) {
    EXPECT_THAT(send("line = \"TRIGER\"", 2).err, HasSubstr("TRIGGER"));
    EXPECT_THAT(send("line_offset = 8", 2).err, HasSubstr("has 8 lines"));
}

TEST_F(TriggerLine, NamesTheRuleWhereTheUserMayNotOpenTheChip) {
    // The group too: where there is no group gpio, the rule leaves the chip to root's.
    const ::passwd* nobody = ::getpwnam("nobody");
    ASSERT_EQ(::setegid(nobody->pw_gid), 0);
    ASSERT_EQ(::seteuid(nobody->pw_uid), 0);
    const std::string sentence = thrown_sentence([] { find_gpio_line(seen_line()); });
    ASSERT_EQ(::seteuid(0), 0);
    ASSERT_EQ(::setegid(0), 0);
    EXPECT_THAT(sentence, HasSubstr("60-vantage-gpio.rules"));
}

}  // namespace
}  // namespace vantage

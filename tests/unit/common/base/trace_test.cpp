#include "common/base/trace/trace.h"

#include <atomic>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/this_thread.h"
#include "common/base/trace/trace_file.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

bool has_logged(const std::string& words) {
    for (const std::string& line : recent_log_lines())
        if (line.find(words) != std::string::npos) return true;
    return false;
}

class Trace : public testing::Test {
  protected:
    std::string file() const { return (folder_.path() / "trace.json").string(); }
    std::string text() const {
        std::stringstream text;
        text << std::ifstream(file()).rdbuf();
        return text.str();
    }
    nlohmann::json events() const { return nlohmann::json::parse(text()); }
    /// The spans of this name, in the order of the file.
    std::vector<nlohmann::json> spans(const std::string& name) const {
        std::vector<nlohmann::json> found;
        for (const nlohmann::json& event : events())
            if (event["ph"] == "X" && event["name"] == name) found.push_back(event);
        return found;
    }

    TemporaryFolder folder_;
};

TEST_F(Trace, HoldsNestedSpansOfTheMonotonicClockOnATrackOfEachThread) {
    const MonotonicTime before = MonotonicClock::now();
    {
        const TraceFile trace(file(), "a \"program\"", false);
        std::thread([] {
            name_this_thread("painter");
            TraceSpan outer("picture");
            outer.with("level", 3);
            const TraceSpan inner("fence");
        }).join();
        std::thread([] {
            name_trace_track("output film \\ \"one\"");
            const TraceSpan span("encode");
        }).join();
    }
    const MonotonicTime after = MonotonicClock::now();
    std::map<int, std::string> tracks;
    std::string program;
    for (const nlohmann::json& event : events()) {
        if (event["name"] == "thread_name") tracks[event["tid"]] = event["args"]["name"];
        if (event["name"] == "process_name") program = event["args"]["name"];
        EXPECT_EQ(event["pid"], getpid());
    }
    EXPECT_EQ(program, "a \"program\"");
    const nlohmann::json outer = spans("picture").at(0), inner = spans("fence").at(0);
    EXPECT_EQ(tracks.at(outer["tid"]), "painter");
    EXPECT_EQ(tracks.at(spans("encode").at(0)["tid"]), "output film \\ \"one\"");
    EXPECT_EQ(outer["tid"], inner["tid"]);
    EXPECT_EQ(outer["args"]["level"], 3);
    const double begin = outer["ts"], length = outer["dur"];
    EXPECT_LE(begin, inner["ts"].get<double>());
    constexpr double rounding_us = 0.001;
    EXPECT_GE(begin + length + rounding_us, inner["ts"].get<double>() + inner["dur"].get<double>());
    EXPECT_GE(begin, to_us(before.time_since_epoch()) - rounding_us);
    EXPECT_LE(begin + length, to_us(after.time_since_epoch()) + rounding_us);
}

TEST_F(Trace, JoinsSpansOfSeveralThreadsToAFlow) {
    {
        const TraceFile trace(file(), "program", false);
        std::thread([] {
            TraceSpan("receive").in(TraceId::of_rig_frame(2, 41), TraceFlow::begins);
        }).join();
        TraceSpan("decode")
            .in(TraceId::of_rig_frame(2, 41), TraceFlow::ends)
            .in(TraceId::of_frame_set(41), TraceFlow::begins);
    }
    std::map<std::string, std::string> places;
    for (const nlohmann::json& event : events())
        if (event.contains("id")) places[event["id"]] += event["ph"].get<std::string>();
    ASSERT_EQ(places.size(), 2u);
    std::multiset<std::string> all;
    for (const auto& [id, place] : places) all.insert(place);
    EXPECT_EQ(all, (std::multiset<std::string>{"s", "sf"}));
    // A viewer binds an arrow to the span around its time on that track.
    for (const nlohmann::json& event : events()) {
        if (!event.contains("id")) continue;
        bool is_within = false;
        for (const std::string name : {"receive", "decode"})
            for (const nlohmann::json& span : spans(name))
                is_within |= span["tid"] == event["tid"] && span["ts"] <= event["ts"];
        EXPECT_TRUE(is_within) << event;
    }
}

TEST_F(Trace, CountsAndNamesWhatAFullRingDrops) {
    constexpr int all = 100;
    {
        TraceFile::Limits limits;
        limits.spans_per_thread = 10;
        limits.period = std::chrono::hours(1);
        const TraceFile trace(file(), "program", false, limits);
        std::thread([] {
            name_this_thread("busy");
            for (int i = 0; i < all; ++i) TraceSpan("span").with("number", i);
        }).join();
    }
    const std::vector<nlohmann::json> kept = spans("span");
    ASSERT_EQ(kept.size(), 10u);
    EXPECT_EQ(kept.back()["args"]["number"], 9) << "the ring keeps what came first";
    EXPECT_TRUE(has_logged("lacks 90 spans"));
    EXPECT_TRUE(has_logged("busy 90"));
}

TEST_F(Trace, LosesNothingOfManyThreadsThatStartAndEnd) {
    constexpr int threads = 60, each = 200;
    {
        TraceFile::Limits limits;
        limits.period = std::chrono::milliseconds(1);
        const TraceFile trace(file(), "program", false, limits);
        std::vector<std::thread> running;
        for (int i = 0; i < threads; ++i)
            running.emplace_back([i] {
                for (int k = 0; k < each; ++k) TraceSpan("span").with("number", each * i + k);
            });
        for (std::thread& thread : running) thread.join();
    }
    std::set<int> numbers;
    for (const nlohmann::json& span : spans("span"))
        numbers.insert(span["args"]["number"].get<int>());
    EXPECT_EQ(numbers.size(), static_cast<std::size_t>(threads * each));
}

TEST_F(Trace, OfAKilledProgramLacksOnlyTheClosingBracket) {
    const pid_t child = fork();
    if (child == 0) {
        TraceFile::Limits limits;
        limits.period = std::chrono::milliseconds(1);
        const TraceFile trace(file(), "program", false, limits);
        for (int i = 0; i < 20; ++i) TraceSpan("span").with("number", i);
        while (trace.written() < 20) usleep(1000);
        usleep(20'000);
        kill(getpid(), SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_TRUE(nlohmann::json::parse(text(), nullptr, false).is_discarded());
    const nlohmann::json events = nlohmann::json::parse(text() + "]");
    EXPECT_EQ(events.size(), 22u) << "names of process and thread, and the spans";
}

TEST_F(Trace, EndsAtItsLargestSizeAndStaysWhole) {
    {
        TraceFile::Limits limits;
        limits.file_bytes = 2000;
        limits.period = std::chrono::milliseconds(1);
        const TraceFile trace(file(), "program", false, limits);
        while (!has_logged("largest size")) {
            { const TraceSpan span("early"); }
            usleep(100);
        }
        { const TraceSpan span("late"); }
    }
    EXPECT_GT(spans("early").size(), 10u);
    EXPECT_EQ(spans("late").size(), 0u);
    EXPECT_TRUE(has_logged("came after the end"));
}

TEST_F(Trace, ReplacesAFileOnlyWhenAsked) {
    std::ofstream(file()) << "precious";
    EXPECT_THROW(TraceFile(file(), "program", false), Error);
    EXPECT_EQ(text(), "precious");
    { const TraceFile trace(file(), "program", true); }
    EXPECT_EQ(events().size(), 1u);
    EXPECT_THROW(TraceFile((folder_.path() / "none" / "t.json").string(), "program", false), Error);
}

TEST_F(Trace, RecordsNothingBeforeAndAfter) {
    { const TraceSpan span("before"); }
    {
        TraceSpan reaching("reaches over the end");
        { const TraceFile trace(file(), "program", false); }
        reaching.end();
    }
    EXPECT_EQ(events().size(), 1u);
}

}  // namespace
}  // namespace vantage

#include <csignal>
#include <cstdlib>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/free_ports.h"
#include "tests/support/source_folder.h"

namespace vantage {
namespace {

/// A take that is played, steered by oscsend and watched by oscdump, each a process of its own.
TEST(Control, OfOthersSteersAShowWhoseLampsTheySee) {
    const TemporaryFolder folder;
    const auto [port, lamps] = two_free_ports();
    ChildProgram watcher("/usr/bin/stdbuf", {"-oL", "oscdump", std::to_string(lamps)},
                         folder.path());
    ChildProgram show(VANTAGE_PROGRAM,
                      {"play", (source_folder() / "tests/takes/version_1.mkv").string(),
                       "--headless", "--size", "96x72", "--loop", "--seconds", "300", "--json",
                       "--control", fmt::format("osc://:{}?lamps=127.0.0.1:{}", port, lamps)},
                      folder.path());
    const auto is_told = [&](const std::string& words) {
        for (int i = 0; i < 3000; ++i) {
            if (watcher.out().find(words) != std::string::npos) return true;
            usleep(20'000);
        }
        return false;
    };
    const auto oscsend = [&](const std::string& words) {
        return std::system(fmt::format("oscsend 127.0.0.1 {} {}", port, words).c_str()) == 0;
    };
    ASSERT_TRUE(is_told("lamp/speed f 1.0")) << watcher.out() << show.err();
    ASSERT_TRUE(oscsend("/vantage/mark_in"));
    EXPECT_TRUE(is_told("lamp/mark_in i 1")) << watcher.out();
    ASSERT_TRUE(oscsend("/vantage/freeze"));
    EXPECT_TRUE(is_told("lamp/hold i 1")) << watcher.out();
    ASSERT_TRUE(oscsend("/vantage/no_such"));
    ASSERT_TRUE(oscsend("/vantage/orbit f 10.0"));
    ASSERT_TRUE(oscsend("/vantage/source_map"));
    EXPECT_TRUE(is_told("lamp/source_map i 1")) << watcher.out();
    show.send_signal(SIGINT);
    const ProgramResult end = show.wait();
    const nlohmann::json summary = nlohmann::json::parse(end.out);
    ASSERT_EQ(summary["control"].size(), 1u);
    EXPECT_EQ(summary["control"][0]["obeyed"], 4);
    EXPECT_EQ(summary["control"][0]["unknown"], 1);
    EXPECT_TRUE(summary["time"]["in"].is_number()) << summary["time"];
}

}  // namespace
}  // namespace vantage

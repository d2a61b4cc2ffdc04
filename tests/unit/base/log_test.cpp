#include "common/base/log.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "common/base/unique_fd.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

/// Everything written to stderr while `action` runs, by lines.
std::vector<std::string> lines_on_stderr(auto&& action) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "stderr";
    {
        const UniqueFd kept(dup(STDERR_FILENO));
        const UniqueFd file(open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600));
        dup2(file.get(), STDERR_FILENO);
        action();
        dup2(kept.get(), STDERR_FILENO);
    }
    std::vector<std::string> lines;
    std::ifstream in(path);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

TEST(Log, WritesTheProgramTheLevelAndTheText) {
    const auto lines = lines_on_stderr([] {
        log_line(LogLevel::info, "to say");
        log_line(LogLevel::warning, "to heed");
        log_error("{} of {}", 3, "4");
    });
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines[0], "base_test: to say");
    EXPECT_EQ(lines[1], "base_test: warning: to heed");
    EXPECT_EQ(lines[2], "base_test: error: 3 of 4");
}

TEST(Log, KeepsLinesOfSeveralThreadsWhole) {
    constexpr int threads = 4, each = 250;
    const auto lines = lines_on_stderr([] {
        std::vector<std::thread> writers;
        for (int t = 0; t < threads; ++t)
            writers.emplace_back([t] {
                for (int i = 0; i < each; ++i)
                    log_line(LogLevel::info, std::string(200, static_cast<char>('a' + t)));
            });
        for (std::thread& writer : writers) writer.join();
    });
    ASSERT_EQ(lines.size(), static_cast<std::size_t>(threads * each));
    for (const std::string& line : lines) {
        const std::string text = line.substr(std::string("base_test: ").size());
        ASSERT_EQ(text.size(), 200u);
        ASSERT_EQ(std::count(text.begin(), text.end(), text[0]), 200) << text;
    }
}

class LogThresholdDeathTest : public testing::Test {
  protected:
    // A fresh process for each, since the threshold is read once.
    void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

void log_all_levels_and_leave() {
    log_debug("d");
    log_info("i");
    log_warning("w");
    log_error("e");
    std::exit(0);
}

TEST_F(LogThresholdDeathTest, IsInfoWithoutAWord) {
    EXPECT_EXIT((unsetenv("VANTAGE_LOG"), log_all_levels_and_leave()), testing::ExitedWithCode(0),
                "^[^\n]*: i\n[^\n]*warning: w\n[^\n]*error: e\n$");
}

TEST_F(LogThresholdDeathTest, IsSetByTheEnvironment) {
    EXPECT_EXIT((setenv("VANTAGE_LOG", "debug", 1), log_all_levels_and_leave()),
                testing::ExitedWithCode(0), "debug: d\n");
    EXPECT_EXIT((setenv("VANTAGE_LOG", "error", 1), log_all_levels_and_leave()),
                testing::ExitedWithCode(0), "^[^\n]*error: e\n$");
}

}  // namespace
}  // namespace vantage

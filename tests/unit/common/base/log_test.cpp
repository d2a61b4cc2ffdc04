#include "common/base/log.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/files/unique_fd.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

using testing::ElementsAre;

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

/// "hh:mm:ss.mmm ", and then the text.
MATCHER_P(IsALineOf, text, "") {
    constexpr std::string_view form = "00:00:00.000 ";
    if (arg.size() != form.size() + std::string_view(text).size()) return false;
    for (std::size_t i = 0; i < form.size(); ++i)
        if (form[i] == '0' ? !std::isdigit(static_cast<unsigned char>(arg[i])) : arg[i] != form[i])
            return false;
    return arg.substr(form.size()) == text;
}

TEST(Log, WritesTheProgramTheLevelAndTheText) {
    const auto lines = lines_on_stderr([] {
        log_line(LogLevel::info, "to say");
        log_line(LogLevel::warning, "to heed");
        log_error("{} of {}", 3, "4");
    });
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_THAT(lines[0], IsALineOf("base_test: to say"));
    EXPECT_THAT(lines[1], IsALineOf("base_test: warning: to heed"));
    EXPECT_THAT(lines[2], IsALineOf("base_test: error: 3 of 4"));
}

TEST(Log, GivesTheTimeOfDay) {
    // By the clock that the log reads: std::time() lags behind it.
    const auto now = [] {
        return std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    };
    std::time_t before = 0, after = 0;
    const auto lines = lines_on_stderr([&] {
        before = now();
        log_info("now");
        after = now();
    });
    std::vector<std::string> possible;
    for (std::time_t second = before; second <= after; ++second) {
        std::tm local{};
        localtime_r(&second, &local);
        possible.push_back(
            fmt::format("{:02}:{:02}:{:02}", local.tm_hour, local.tm_min, local.tm_sec));
    }
    EXPECT_THAT(possible, testing::Contains(lines.at(0).substr(0, 8)));
}

TEST(Log, LeavesTheTimeToTheJournal) {
    const auto lines = lines_on_stderr([] {
        struct stat file {};
        fstat(STDERR_FILENO, &file);
        setenv("JOURNAL_STREAM", fmt::format("{}:{}", file.st_dev, file.st_ino).c_str(), 1);
        log_info("to the journal");
        setenv("JOURNAL_STREAM", fmt::format("{}:{}", file.st_dev, file.st_ino + 1).c_str(), 1);
        log_info("to a file, from a service");
        unsetenv("JOURNAL_STREAM");
    });
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_EQ(lines[0], "base_test: to the journal");
    EXPECT_THAT(lines[1], IsALineOf("base_test: to a file, from a service"));
}

TEST(Log, TheSentenceAProgramEndsWithStandsAlone) {
    EXPECT_THAT(lines_on_stderr([] { say_error("no such file"); }),
                ElementsAre("base_test: error: no such file"));
}

TEST(Log, KeepsALineBreakOfAFileNameWithinTheLine) {
    const auto lines = lines_on_stderr([] {
        log_info("cannot read {}", "left\n1\x1b[2J.jpg");
        say_error("no file left\n2.jpg");
    });
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_THAT(lines[0], IsALineOf("base_test: cannot read left\\n1\\x1b[2J.jpg"));
    EXPECT_EQ(lines[1], "base_test: error: no file left\\n2.jpg");
}

TEST(Log, WarnsOnceUnderAKey) {
    const auto lines = lines_on_stderr([] {
        log_warning_once("log_test a", "first");
        log_warning_once("log_test a", "second");
        log_warning_once("log_test b", "third");
    });
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_THAT(lines[0], IsALineOf("base_test: warning: first"));
    EXPECT_THAT(lines[1], IsALineOf("base_test: warning: third"));
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
        const std::string text = line.substr(std::string("hh:mm:ss.mmm base_test: ").size());
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

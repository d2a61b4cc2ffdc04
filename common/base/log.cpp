#include "common/base/log.h"

#include <cerrno>
#include <cstdlib>
#include <deque>
#include <mutex>
#include <set>
#include <string>

#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

namespace vantage {
namespace {

LogLevel threshold_from_environment() {
    const char* value = std::getenv("VANTAGE_LOG");
    const std::string_view name = value ? value : "info";
    if (name == "debug") return LogLevel::debug;
    if (name == "warning") return LogLevel::warning;
    if (name == "error") return LogLevel::error;
    return LogLevel::info;
}

std::string_view level_name(LogLevel level) {
    switch (level) {
        case LogLevel::debug:
            return "debug: ";
        case LogLevel::info:
            return "";
        case LogLevel::warning:
            return "warning: ";
        case LogLevel::error:
            return "error: ";
    }
    return "";
}

/// systemd.exec(5): JOURNAL_STREAM names the device and inode of the stream to the journal.
bool stderr_is_the_journal() {
    const char* stream = std::getenv("JOURNAL_STREAM");
    struct stat file {};
    return stream && ::fstat(STDERR_FILENO, &file) == 0 &&
           stream == fmt::format("{}:{}", file.st_dev, file.st_ino);
}

std::string time_of_day() {
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    tm local{};
    localtime_r(&now.tv_sec, &local);
    return fmt::format("{:02}:{:02}:{:02}.{:03} ", local.tm_hour, local.tm_min, local.tm_sec,
                       now.tv_nsec / 1'000'000);
}

/// The newest log lines of the process, shared by all threads.
struct RecentLines {
    std::mutex mutex;
    std::deque<std::string> lines;
};
RecentLines& recent() {
    static RecentLines lines;
    return lines;
}

/// A line stays one: a file name may hold a line break, or what a terminal obeys.
std::string on_one_line(std::string_view text) {
    std::string line;
    line.reserve(text.size());
    for (const char c : text) {
        constexpr unsigned char first_printable = 0x20, del = 0x7f;
        const auto code = static_cast<unsigned char>(c);
        if (code >= first_printable && code != del)
            line += c;
        else if (c == '\n')
            line += "\\n";
        else if (c == '\t')
            line += ' ';
        else
            line += fmt::format("\\x{:02x}", code);
    }
    return line;
}

void remember(LogLevel level, std::string_view text) {
    RecentLines& all = recent();
    std::string line = fmt::format("{}{}{}", time_of_day(), level_name(level), text);
    const std::lock_guard lock(all.mutex);
    all.lines.push_back(std::move(line));
    if (all.lines.size() > most_recent_lines) all.lines.pop_front();
}

void write_line(std::string_view time, LogLevel level, std::string_view text) {
    const std::string line =
        fmt::format("{}{}: {}{}\n", time, program_invocation_short_name, level_name(level), text);
    std::string_view rest = line;
    while (!rest.empty()) {
        const ssize_t written = ::write(STDERR_FILENO, rest.data(), rest.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return;
        rest.remove_prefix(static_cast<std::size_t>(written));
    }
}

}  // namespace

LogLevel log_threshold() {
    static const LogLevel threshold = threshold_from_environment();
    return threshold;
}

void log_line(LogLevel level, std::string_view text) {
    const std::string line = on_one_line(text);
    remember(level, line);
    write_line(stderr_is_the_journal() ? "" : time_of_day(), level, line);
}

void log_warning_once(std::string_view key, std::string_view text) {
    static std::mutex mutex;
    static std::set<std::string, std::less<>> known;
    {
        const std::lock_guard lock(mutex);
        if (!known.emplace(key).second) return;
    }
    log_warning("{}", text);
}

std::vector<std::string> recent_log_lines() {
    RecentLines& all = recent();
    const std::lock_guard lock(all.mutex);
    return {all.lines.begin(), all.lines.end()};
}

void say_error(std::string_view text) { write_line("", LogLevel::error, on_one_line(text)); }

}  // namespace vantage

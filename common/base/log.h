#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace vantage {

enum class LogLevel { debug, info, warning, error };

/// Writes one line to stderr, "hh:mm:ss.mmm name: level: text", by the clock on the wall; without
/// the time where stderr is systemd's journal, which has it. One write(2) a line, so lines of
/// several threads and processes never mix; control characters in the text, as a file name may
/// have them, are written as escapes. Results go to stdout, everything else through here.
void log_line(LogLevel level, std::string_view text);

/// Writes a warning the first time that this process has one under this key, and says then that
/// there will be no other: for a property that all pictures of a series or camera share.
void log_warning_once(std::string_view key, std::string_view text);

/// The sentence that a program ends with: as a log line of an error, but without the time.
void say_error(std::string_view text);

/// Lines below this level are not written. The default is info; the environment variable
/// VANTAGE_LOG=debug|info|warning|error sets it at start.
LogLevel log_threshold();

/// The last lines that were written, oldest first, with their time: for who asks what happened.
std::vector<std::string> recent_log_lines();
inline constexpr std::size_t most_recent_lines = 300;

template <class... Args>
void log_debug(fmt::format_string<Args...> format, Args&&... args) {
    if (log_threshold() <= LogLevel::debug)
        log_line(LogLevel::debug, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void log_info(fmt::format_string<Args...> format, Args&&... args) {
    if (log_threshold() <= LogLevel::info)
        log_line(LogLevel::info, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void log_warning(fmt::format_string<Args...> format, Args&&... args) {
    if (log_threshold() <= LogLevel::warning)
        log_line(LogLevel::warning, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void log_error(fmt::format_string<Args...> format, Args&&... args) {
    log_line(LogLevel::error, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace vantage

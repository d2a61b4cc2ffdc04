#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace vantage {

enum class LogLevel { debug, info, warning, error };

/// Writes one line to stderr: "hh:mm:ss.mmm name: level: text", in local time. The time is omitted
/// where stderr is systemd's journal, which adds its own. Each line is one write(2), so that lines
/// of several threads and processes never mix. Control characters in the text, which a file name
/// may contain, are written as escapes. Results go to stdout, everything else through here.
void log_line(LogLevel level, std::string_view text);

/// Writes a warning only the first time that it is given with this key, and adds that it will not
/// be repeated. For a property that all images of a series or of a camera share.
void log_warning_once(std::string_view key, std::string_view text);

/// Writes the sentence that a program ends with: an error line without the time.
void say_error(std::string_view text);

/// The lowest level that is written: info by default; the environment variable
/// VANTAGE_LOG=debug|info|warning|error changes it.
LogLevel log_threshold();

/// The newest lines with their times, oldest first, for bug reports.
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

#include "common/base/log.h"

#include <cerrno>
#include <cstdlib>
#include <string>

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

}  // namespace

LogLevel log_threshold() {
    static const LogLevel threshold = threshold_from_environment();
    return threshold;
}

void log_line(LogLevel level, std::string_view text) {
    const std::string line =
        fmt::format("{}: {}{}\n", program_invocation_short_name, level_name(level), text);
    std::string_view rest = line;
    while (!rest.empty()) {
        const ssize_t written = ::write(STDERR_FILENO, rest.data(), rest.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return;
        rest.remove_prefix(static_cast<std::size_t>(written));
    }
}

}  // namespace vantage

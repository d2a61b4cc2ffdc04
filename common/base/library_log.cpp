#include "common/base/library_log.h"

#include <algorithm>
#include <string_view>

namespace vantage {
namespace {

/// Counts by library. Never destroyed, since libraries write on threads of their own to the end.
struct LibraryCounts {
    std::mutex mutex;
    std::vector<std::pair<std::string, std::uint64_t>> all;
};

LibraryCounts& library_counts() {
    static auto* const counts = new LibraryCounts;
    return *counts;
}

/// Returns the number of messages of this library since the start.
std::uint64_t count_message(const std::string& library) {
    LibraryCounts& counts = library_counts();
    const std::lock_guard lock(counts.mutex);
    for (auto& [name, count] : counts.all)
        if (name == library) return ++count;
    counts.all.emplace_back(library, 1);
    return 1;
}

}  // namespace

LibraryLog::LibraryLog(std::string library, LogLevel level)
    : library_(std::move(library)), level_(level) {}

void LibraryLog::note(std::string message) {
    while (!message.empty() && (message.back() == '\n' || message.back() == ' '))
        message.pop_back();
    // libsrt leaves the separator of a prefix that was switched off.
    message.erase(0, std::min(message.find_first_not_of(": "), message.size()));
    if (message.empty()) return;
    const std::uint64_t all = count_message(library_);
    const std::lock_guard lock(mutex_);
    const auto times = limiter_.count(1, MonotonicClock::now());
    if (!times || level_ < log_threshold()) return;
    log_line(level_, *times == 1 ? fmt::format("{}: {}", library_, message)
                                 : fmt::format("{}: {} messages ({} since the start), the last: {}",
                                               library_, *times, all, message));
}

std::vector<std::pair<std::string, std::uint64_t>> LibraryLog::counts() {
    LibraryCounts& counts = library_counts();
    const std::lock_guard lock(counts.mutex);
    return counts.all;
}

void keep_srt_message(void*, int, const char*, int, const char* area, const char* message) {
    static LibraryLog correction("libsrt's error correction", LogLevel::debug);
    static LibraryLog log("libsrt", LogLevel::warning);
    // The packet filter, as libsrt calls it.
    const bool is_correction = std::string_view(area ? area : "").ends_with("pf");
    (is_correction ? correction : log).note(message ? message : "");
}

}  // namespace vantage

#include "common/av/av_log.h"

#include <array>
#include <cstdarg>
#include <cstdint>
#include <mutex>
#include <utility>

#include <dlfcn.h>

extern "C" {
#include <libavutil/log.h>
}

#include "common/base/log.h"
#include "common/base/log_limiter.h"
#include "common/base/time/time.h"

namespace vantage {
namespace {

thread_local std::string remark;

void keep(void* source, int level, const char* format, va_list words) {
    if (level > AV_LOG_ERROR) return;
    std::array<char, 512> line{};
    int has_prefix = 0;
    av_log_format_line2(source, level, format, words, line.data(), line.size(), &has_prefix);
    std::string text(line.data());
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    if (text.empty()) return;
    log_debug("FFmpeg: {}", text);
    remark = std::move(text);
}

/// What libsrt writes by itself: callers that are refused would bring four lines every 10 ms. It is
/// called on threads of libsrt.
class SrtLog {
  public:
    static void write(void*, int, const char*, int, const char*, const char* message) {
        static SrtLog log;
        log.note(message ? message : "");
    }

  private:
    void note(std::string text) {
        while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
        const std::lock_guard lock(mutex_);
        ++all_;
        if (const auto times = limiter_.count(1, MonotonicClock::now()))
            log_warning("libsrt: {} messages ({} since the start), the last: {}", *times, all_,
                        text);
    }

    std::mutex mutex_;
    LogLimiter limiter_{std::chrono::seconds(10)};
    std::uint64_t all_ = 0;
};

/// FFmpeg brings libsrt along and has no function for its log: it is found by name where it is
/// there.
void keep_srt_log() {
    using Handler = void(void*, int, const char*, int, const char*, const char*);
    auto* const set_handler =
        reinterpret_cast<void (*)(void*, Handler*)>(dlsym(RTLD_DEFAULT, "srt_setloghandler"));
    auto* const set_flags = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "srt_setlogflags"));
    // Without its own time, thread, severity and end of line.
    constexpr int text_alone = 1 | 2 | 4 | 8;
    if (set_flags) set_flags(text_alone);
    if (set_handler) set_handler(nullptr, SrtLog::write);
}

}  // namespace

void keep_av_log() {
    static const bool is_kept = [] {
        av_log_set_callback(keep);
        keep_srt_log();
        return true;
    }();
    (void)is_kept;
}

std::string take_av_remark() { return std::exchange(remark, {}); }

}  // namespace vantage

#include "common/av/av_log.h"

#include <array>
#include <cstdarg>
#include <utility>

#include <dlfcn.h>

extern "C" {
#include <libavutil/log.h>
}

#include "common/base/library_log.h"
#include "common/base/log.h"

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

/// FFmpeg loads libsrt and has no function for its log, so the functions are looked up by name.
void keep_srt_log() {
    using Handler = void(void*, int, const char*, int, const char*, const char*);
    auto* const set_handler =
        reinterpret_cast<void (*)(void*, Handler*)>(dlsym(RTLD_DEFAULT, "srt_setloghandler"));
    auto* const set_flags = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "srt_setlogflags"));
    // Leaves out the time, the thread, the severity and the end of the line.
    constexpr int text_alone = 1 | 2 | 4 | 8;
    if (set_flags) set_flags(text_alone);
    if (set_handler) set_handler(nullptr, keep_srt_message);
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

#include "common/av/av_log.h"

#include <array>
#include <cstdarg>
#include <utility>

extern "C" {
#include <libavutil/log.h>
}

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

}  // namespace

void keep_av_log() { av_log_set_callback(keep); }

std::string take_av_remark() { return std::exchange(remark, {}); }

}  // namespace vantage

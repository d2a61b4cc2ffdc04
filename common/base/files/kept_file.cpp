#include "common/base/files/kept_file.h"

#include <chrono>
#include <span>
#include <utility>

#include "common/base/files/atomic_file.h"
#include "common/base/files/output_path.h"
#include "common/base/log.h"

namespace vantage {
namespace {

constexpr std::chrono::seconds patience{1};

}  // namespace

KeptFile::KeptFile(std::filesystem::path file, std::string what)
    : file_(std::move(file)), what_(std::move(what)), is_there_(std::filesystem::exists(file_)) {
    if (is_there_) bytes_ = read_file(file_, most_bytes);
}

void KeptFile::note_change() {
    if (!changed_) changed_ = MonotonicClock::now();
}

bool KeptFile::is_due(MonotonicTime now) const { return changed_ && now - *changed_ >= patience; }

void KeptFile::put_aside(const char* why) const {
    const std::filesystem::path aside = free_path(file_);
    std::filesystem::rename(file_, aside);
    log_info("renamed {} to {}, because {}", file_.string(), aside.string(), why);
}

bool KeptFile::write(const std::string& text, const char* makes_room) {
    const auto fresh = std::as_bytes(std::span(text));
    try {
        if (std::filesystem::exists(file_)) {
            const bool is_ours = read_file(file_, most_bytes) == bytes_;
            if (!is_ours)
                put_aside("another program has changed it");
            else if (makes_room)
                put_aside(makes_room);
        }
        write_file_atomically(file_, fresh);
        bytes_.assign(fresh.begin(), fresh.end());
        changed_.reset();
        has_failed_ = false;
        return true;
    } catch (const std::exception& error) {
        if (!std::exchange(has_failed_, true))
            log_error("cannot save {}, and will try again: {}", what_, error.what());
        changed_ = MonotonicClock::now();
        return false;
    }
}

}  // namespace vantage

#include "host_app/session/background_saver.h"

#include <chrono>

#include "common/base/error.h"
#include "common/base/files/output_path.h"
#include "common/base/log.h"
#include "host_app/background/background_file.h"

namespace vantage {

BackgroundSaver::BackgroundSaver(LiveShow& show, std::filesystem::path path) : show_(show), path_(std::move(path)) {
    if (path_.empty()) return;
    if (std::filesystem::exists(path_))
        fail("the set cannot be saved to {}: there is such a file; move it or name another",
             path_.string());
    require_writable_output(path_, {});
}

void BackgroundSaver::save() {
    if (work_.valid() && work_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
        log_warning("a set is being saved: the next one can be when that is done");
        return;
    }
    const std::filesystem::path path =
        free_path(path_.empty() ? name_for_now("set", background_file_extension) : path_);
    work_ = std::async(std::launch::async, [this, set = show_.background(), path]() mutable {
        write(std::move(set), path);
    });
}

void BackgroundSaver::write(std::future<Background> set, const std::filesystem::path& path) {
    std::string failure;
    try {
        save_background(set.get(), path);
        log_info("the set was saved to {}", path.string());
    } catch (const std::exception& error) {
        failure = fmt::format("the set was not saved to {}: {}", path.string(), error.what());
        log_error("{}", failure);
    }
    const std::lock_guard lock(mutex_);
    if (failure.empty()) state_.path = path;
    state_.failure = failure;
}

void BackgroundSaver::finish() {
    if (work_.valid()) work_.wait();
}

BackgroundSaver::State BackgroundSaver::state() const {
    const std::lock_guard lock(mutex_);
    return state_;
}

}  // namespace vantage

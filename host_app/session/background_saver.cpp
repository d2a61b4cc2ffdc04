#include "host_app/session/background_saver.h"

#include <chrono>

#include "common/base/error.h"
#include "common/base/files/output_path.h"
#include "common/base/log.h"
#include "host_app/background/background_file.h"

namespace vantage {

BackgroundSaver::BackgroundSaver(LiveShow& show, std::filesystem::path path)
    : show_(show), path_(std::move(path)) {
    if (path_.empty()) return;
    if (std::filesystem::exists(path_))
        fail("cannot save the background to {}: the file exists; move it or choose another name",
             path_.string());
    require_writable_output(path_, {});
}

void BackgroundSaver::save() {
    if (work_.valid() && work_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
        log_warning("the background is still being saved; save again when that is done");
        return;
    }
    const std::filesystem::path path =
        free_path(path_.empty() ? name_for_now("background", background_file_extension) : path_);
    work_ = std::async(std::launch::async, [this, background = show_.background(), path]() mutable {
        write(std::move(background), path);
    });
}

void BackgroundSaver::write(std::future<Background> background, const std::filesystem::path& path) {
    std::string failure;
    try {
        save_background(background.get(), path);
        log_info("saved the background to {}", path.string());
    } catch (const std::exception& error) {
        failure =
            fmt::format("could not save the background to {}: {}", path.string(), error.what());
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

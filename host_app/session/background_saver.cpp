#include "host_app/session/background_saver.h"

#include <chrono>

#include "common/base/error.h"
#include "common/base/files/output_path.h"
#include "common/base/log.h"
#include "host_app/background/background_file.h"

namespace vantage {

SetDesk::SetDesk(LiveShow& show, std::filesystem::path path) : show_(show), path_(std::move(path)) {
    if (path_.empty()) return;
    if (std::filesystem::exists(path_))
        fail("the set cannot be saved to {}: there is such a file; move it or name another",
             path_.string());
    require_writable_output(path_, {});
}

void SetDesk::save() {
    if (work_.valid() && work_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
        log_warning("a set is being saved: the next one can be when that is done");
        return;
    }
    const std::filesystem::path path =
        free_path(path_.empty() ? name_for_now("set", set_file_extension) : path_);
    work_ = std::async(std::launch::async, [this, set = show_.learnt_set(), path]() mutable {
        write(std::move(set), path);
    });
}

void SetDesk::write(std::future<LearntSet> set, const std::filesystem::path& path) {
    std::string failure;
    try {
        save_set(set.get(), path);
        log_info("the set was saved to {}", path.string());
    } catch (const std::exception& error) {
        failure = fmt::format("the set was not saved to {}: {}", path.string(), error.what());
        log_error("{}", failure);
    }
    const std::lock_guard lock(mutex_);
    if (failure.empty()) state_.path = path;
    state_.failure = failure;
}

void SetDesk::finish() {
    if (work_.valid()) work_.wait();
}

SetDesk::State SetDesk::state() const {
    const std::lock_guard lock(mutex_);
    return state_;
}

}  // namespace vantage

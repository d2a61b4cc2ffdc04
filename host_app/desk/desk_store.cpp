#include "host_app/desk/desk_store.h"

namespace vantage {

DeskStore::DeskStore(std::filesystem::path file)
    : file_(std::move(file), "the desk's arrangements") {
    if (file_.is_there()) desk_ = load_desk(file_.path());
}

void DeskStore::follow(const DeskArrangement& desk, MonotonicTime now) {
    // The first place of a window is nobody's wish.
    const bool is_changed = desk.switches != desk_.switches ||
                            (desk_.window && desk.window != desk_.window) ||
                            (desk_.rigs_window && desk.rigs_window != desk_.rigs_window);
    if (is_changed) file_.note_change();
    desk_ = desk;
    if (file_.is_due(now)) (void)file_.write(to_toml(desk_));
}

void DeskStore::finish() {
    if (file_.is_changed()) (void)file_.write(to_toml(desk_));
}

std::filesystem::path desk_file_of(std::filesystem::path file) {
    return file.replace_extension(".desk.toml");
}

}  // namespace vantage

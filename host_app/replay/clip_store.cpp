#include "host_app/replay/clip_store.h"

#include "host_app/replay/clip_file.h"

namespace vantage {

ClipStore::ClipStore(std::filesystem::path file, double pulse_rate_hz)
    : file_(std::move(file), "clips and play list") {
    ClipBook book;
    book.pulse_rate_hz = pulse_rate_hz;
    if (file_.is_there()) book = load_clips(file_.path(), pulse_rate_hz);
    book_ = std::make_shared<const ClipBook>(std::move(book));
}

void ClipStore::follow(const std::shared_ptr<const ClipBook>& book, MonotonicTime now) {
    if (book && book != book_) {
        if (*book != *book_) file_.note_change();
        book_ = book;
    }
    if (file_.is_due(now)) (void)file_.write(to_toml(*book_));
}

void ClipStore::finish() {
    if (file_.is_changed()) (void)file_.write(to_toml(*book_));
}

std::filesystem::path clip_file_of(std::filesystem::path file) {
    return file.replace_extension(".clips.toml");
}

}  // namespace vantage

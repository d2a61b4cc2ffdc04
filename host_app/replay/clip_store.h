#pragma once

#include <filesystem>
#include <memory>

#include "common/base/files/kept_file.h"
#include "host_app/replay/clip.h"

namespace vantage {

/// Keeps a show's clips and play list in a clip file, beside the stage's or the take's; see
/// KeptFile for when it is written and what it replaces. Of the session's thread.
class ClipStore {
  public:
    /// Reads the file where there is one. Throws Error as load_clips().
    ClipStore(std::filesystem::path file, double pulse_rate_hz);

    /// What the session begins with.
    const ClipBook& book() const { return *book_; }
    /// To be called often, with what there is now: writes what is due.
    void follow(const std::shared_ptr<const ClipBook>& book, MonotonicTime now);
    /// Writes all that is not written yet.
    void finish();

  private:
    KeptFile file_;
    std::shared_ptr<const ClipBook> book_;
};

/// STAGE.clips.toml beside STAGE.toml, TAKE.clips.toml beside TAKE.mkv.
std::filesystem::path clip_file_of(std::filesystem::path file);

}  // namespace vantage

#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "common/base/files/kept_file.h"
#include "host_app/replay/clip.h"

namespace vantage {

/// Reads a clip file (docs/reference/formats.md shows every key). Throws Error with file and line
/// if a value does not fit, and if the file has another pulse rate.
ClipBook load_clips(const std::filesystem::path& path, double pulse_rate_hz);

/// The text of a clip file, which load_clips() reads back.
std::string to_toml(const ClipBook& book);

/// Keeps the clips and the play list of a show in a clip file beside the stage file or the take;
/// see KeptFile for when it is written and which file it replaces. Used on the session's thread
/// only.
class ClipStore {
  public:
    /// Reads the file if it exists. Throws Error as load_clips() does.
    ClipStore(std::filesystem::path file, double pulse_rate_hz);

    /// The book to start the session with.
    const ClipBook& book() const { return *book_; }
    /// Takes over the present book and writes changes that are due; to be called often.
    void follow(const std::shared_ptr<const ClipBook>& book, MonotonicTime now);
    /// Writes all changes.
    void finish();

  private:
    KeptFile file_;
    std::shared_ptr<const ClipBook> book_;
};

/// Name of the clip file: STAGE.clips.toml for STAGE.toml, TAKE.clips.toml for TAKE.mkv.
std::filesystem::path clip_file_of(std::filesystem::path file);

}  // namespace vantage

#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/av/av_handles.h"
#include "common/av/sound.h"
#include "common/base/files/unique_fd.h"

namespace vantage {

/// The finished parts of a film in a folder. Each is a complete film of consecutive pictures with
/// the same encoder settings, so that they are joined without re-encoding. Locked by one process at
/// a time. Not thread-safe.
class FilmParts {
  public:
    /// The folder for the parts of a film: NAME.parts.
    static std::filesystem::path folder_of(const std::filesystem::path& film);

    /// Precondition: the folder exists and contains export.json. Throws Error if another process
    /// has locked it, or a part cannot be read.
    FilmParts(std::filesystem::path folder, double rate_hz);

    /// Number of finished pictures, without a gap from the first.
    std::uint64_t pictures() const { return pictures_; }
    /// The file of the next part.
    std::filesystem::path next() const;
    /// Adds the next part after it was written. Throws Error if its picture count is wrong.
    void add(std::uint64_t pictures);

    /// Joins the parts into the film, which begins at this time code. `sound`: one block per
    /// picture; empty: no sound. Precondition: there is a part. Throws Error if the disk fails or
    /// parts differ in encoding.
    void join(const std::filesystem::path& film, const std::string& timecode,
              const std::vector<std::shared_ptr<const SoundBlock>>& sound = {}) const;

  private:
    struct Part {
        std::filesystem::path file;
        std::uint64_t first = 0, pictures = 0;
        std::int64_t delay = 0;  ///< largest decoding delay in pictures
    };
    void take_in(std::filesystem::path file);

    std::filesystem::path folder_;
    double rate_hz_;
    AVRational tick_;  ///< seconds per picture
    UniqueFd lock_;
    std::vector<Part> parts_;
    std::uint64_t pictures_ = 0;
};

}  // namespace vantage

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

/// A film on its way: parts of it in a folder, each a whole film of the pictures from a number on,
/// made with the same settings. A part is there when it is whole; all of them are joined into the
/// film without coding anything anew. Held by one process at a time.
class FilmParts {
  public:
    /// The folder of the parts of a film of this name: NAME.parts.
    static std::filesystem::path folder_of(const std::filesystem::path& film);

    /// The folder is there, with export.json in it. Throws Error if another process holds it, or a
    /// part in it cannot be read.
    FilmParts(std::filesystem::path folder, double rate_hz);

    /// Pictures that are there, from the first on without a gap.
    std::uint64_t pictures() const { return pictures_; }
    /// The file of the part that comes next.
    std::filesystem::path next() const;
    /// That part is written. Throws Error if it has not so many pictures.
    void add(std::uint64_t pictures);

    /// Joins them into the film, which begins at this time code. Precondition: there is one. Throws
    /// Error if the disk fails, or parts do not fit each other. `sound`: of every picture; empty:
    /// none.
    void join(const std::filesystem::path& film, const std::string& timecode,
              const std::vector<std::shared_ptr<const SoundBlock>>& sound = {}) const;

  private:
    struct Part {
        std::filesystem::path file;
        std::uint64_t first = 0, pictures = 0;
        std::int64_t delay = 0;  ///< pictures that its decoder has to wait for others at most
    };
    void take_in(std::filesystem::path file);

    std::filesystem::path folder_;
    double rate_hz_;
    AVRational tick_;  ///< s a picture
    UniqueFd lock_;
    std::vector<Part> parts_;
    std::uint64_t pictures_ = 0;
};

}  // namespace vantage

#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vantage {

/// The only name, if it is a video file; empty for pictures, patterns and folders.
std::filesystem::path film_among(const std::vector<std::string>& names);

/// Frames of one or two videos as pictures in a temporary folder, which the destructor removes.
/// Frames of one number have one number in their names.
class FilmFrames {
  public:
    /// Takes at most `most` frames, evenly spread over the shorter video. Throws Error if a video
    /// cannot be read.
    FilmFrames(const std::vector<std::filesystem::path>& films, std::size_t most);
    FilmFrames(const FilmFrames&) = delete;
    FilmFrames& operator=(const FilmFrames&) = delete;
    ~FilmFrames();

    /// The pictures of each video.
    const std::vector<std::vector<std::filesystem::path>>& pictures() const { return pictures_; }

  private:
    std::filesystem::path folder_;
    std::vector<std::vector<std::filesystem::path>> pictures_;
};

}  // namespace vantage

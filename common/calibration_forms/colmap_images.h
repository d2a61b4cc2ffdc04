#pragma once

#include <filesystem>
#include <optional>
#include <sstream>
#include <string>

#include "common/geometry/pose.h"

namespace vantage {

struct ColmapImage {
    Pose camera_from_world;
    int camera = 0, line = 0;
    std::string name;  ///< the rest of its line: it may have spaces
};

/// The images of an images.txt. COLMAP writes two lines an image, of which the second holds the
/// points; other programs leave that line out, or empty, or end lines with CR LF.
class ColmapImages {
  public:
    ColmapImages(const std::string& text, std::filesystem::path file);

    /// The next image; empty at the end. Throws Error for a line that is neither an image nor the
    /// points of the one before it, and at the end if the header states another number of images.
    std::optional<ColmapImage> next();

  private:
    bool next_line();
    void note_stated_count();
    bool is_points() const;
    ColmapImage image() const;

    std::istringstream lines_;
    std::filesystem::path file_;
    std::string line_;
    int number_ = 0;
    bool may_be_points_ = false;  ///< the line after an image
    std::size_t count_ = 0;
    std::optional<std::size_t> stated_count_;
};

}  // namespace vantage

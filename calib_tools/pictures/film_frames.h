#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calib_tools/pictures/seen_picture.h"

namespace vantage {

/// The only name, if it is a video file; empty for pictures, patterns and folders.
std::filesystem::path film_among(const std::vector<std::string>& names);

/// Most frames of a video that are searched for the board.
inline constexpr std::size_t most_film_frames = 60;

/// Reads frames of one or two videos, as pictures that are not searched for a board yet. It takes
/// at most `most` frames, evenly spread over the shorter video. All videos have equally many, and
/// frames at one place have one number. Throws Error if a video cannot be read.
std::vector<std::vector<SeenPicture>> read_film_frames(
    const std::vector<std::filesystem::path>& films, std::size_t most = most_film_frames);

/// Reads picture files, as pictures that are not searched for a board yet. Files that cannot be
/// read have no pixels; the search gives the reason.
std::vector<SeenPicture> read_pictures(const std::vector<std::filesystem::path>& files);

/// Both sides of a pair, with one picture each at every place.
struct PictureHalves {
    std::vector<SeenPicture> left, right;
};

/// Cuts each picture in the middle. Throws Error, naming the picture, if its width is odd.
PictureHalves halves_of(const std::vector<SeenPicture>& both);

}  // namespace vantage

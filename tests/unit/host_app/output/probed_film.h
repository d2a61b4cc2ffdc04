#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/av/av_handles.h"

namespace vantage {

/// What a video file holds, as FFmpeg's demuxer and decoder find it.
struct ProbedFilm {
    std::string codec, container;
    std::string timecode;  ///< of the stream of pictures
    int width_px = 0, height_px = 0;
    double duration_s = 0;
    AVRational rate{};                       ///< as the container tells it
    std::vector<double> times_s;             ///< of every decoded picture
    std::vector<std::uint8_t> middle_lumas;  ///< Y' of the pixel in the middle of every picture
};

ProbedFilm probe_film(const std::filesystem::path& path);

}  // namespace vantage

#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/image/image.h"

namespace vantage {

/// Decoder of a video file in any format of FFmpeg, frame by frame. Use it from one thread.
class VideoReader {
  public:
    /// Throws Error, naming the file, if it cannot be read as a video.
    explicit VideoReader(const std::string& path);
    ~VideoReader();

    /// Next frame; empty at the end. Throws Error for a frame that is damaged or too large.
    std::optional<ColourImage> next();

    const char* codec_name() const;
    /// Frame rate of the file in frames per second; 0 if it states none.
    double rate_hz() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage

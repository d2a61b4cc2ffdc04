#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/image/image.h"

namespace vantage {

/// Decodes the pictures of a video file of any form that FFmpeg knows, one after the other.
class VideoReader {
  public:
    /// Throws Error, naming the file, if it cannot be read as a video.
    explicit VideoReader(const std::string& path);
    ~VideoReader();

    /// Empty at the end. Throws Error for what is damaged or too large.
    std::optional<ColourImage> next();

    const char* codec_name() const;
    /// Pictures a second as the file states them; 0: it does not say.
    double rate_hz() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage

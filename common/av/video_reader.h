#pragma once

#include <cstdint>
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

    /// Decodes and drops frames. Returns false if the video ends before them.
    bool skip(std::uint64_t frames);

    /// Makes this frame the next one, by its time. Returns false, with the reader at any place, if
    /// the file has no constant rate or cannot be searched.
    bool seek(std::uint64_t frame);

    /// Number of the last key frame at or before this frame, by the file's index; empty if the file
    /// has no index or no constant rate. Decoding can begin there.
    std::optional<std::uint64_t> key_frame_before(std::uint64_t frame) const;

    /// Number of frames, as the file states it or counted in the file without decoding them; the
    /// decoder may deliver fewer. Call it before next().
    std::uint64_t count();

    const char* codec_name() const;
    /// Frame rate of the file in frames per second; 0 if it states none.
    double rate_hz() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage

#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <string>
#include <thread>

#include "common/base/bounded_queue.h"
#include "common/base/percentiles.h"
#include "host_app/output/video_writer.h"

namespace vantage {

/// Writes a film on a thread of its own, so that the encoder never holds up the picture. When the
/// encoder cannot follow, the oldest waiting picture is left out of the film and counted; the
/// others keep their times. When the disk fails, what was written is kept where it can be read, and
/// the Error says so.
class VideoRecorder {
  public:
    /// Throws Error as VideoWriter does.
    VideoRecorder(const std::filesystem::path& path, const VideoSettings& settings);
    ~VideoRecorder();

    /// Shares the picture, which must not be changed afterwards; else as VideoWriter::add. Throws
    /// Error if the writing thread has failed.
    void add(const ColourImage& picture, std::chrono::nanoseconds time, std::string timecode = {});

    /// Writes what waits, ends the film. Throws Error if anything failed.
    void finish();

    std::uint64_t dropped() const { return queue_.dropped_count(); }
    /// After finish().
    std::uint64_t frames() const { return writer_.frames(); }
    Percentiles encode_ms() const { return encode_ms_.summary(); }

  private:
    struct Picture {
        ColourImage image;
        std::chrono::nanoseconds time{};
        std::string timecode;
    };
    void write();
    /// Keeps what can be kept; what to throw.
    std::exception_ptr end_after(const std::exception& error);

    VideoWriter writer_;
    BoundedQueue<Picture> queue_;
    PercentileRecorder encode_ms_;
    std::exception_ptr failure_;  ///< read by others only once failed_ is set
    std::atomic<bool> failed_ = false;
    std::thread thread_;
};

}  // namespace vantage

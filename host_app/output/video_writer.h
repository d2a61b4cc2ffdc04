#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>

#include "common/av/av_handles.h"
#include "common/image/image.h"

namespace vantage {

struct VideoSettings {
    int width_px = 0, height_px = 0;  ///< of the pictures; an odd last row or column is left out
    double rate_hz = 30;              ///< nominal; every picture carries its own time
    double quality = 20;              ///< x264's constant rate factor, 0 (lossless) .. 51
};

/// Writes a video file, H.264 in Matroska or MP4 by the path's extension (.mkv, .mp4), colours by
/// ITU-R BT.709. Where FFmpeg comes without an H.264 encoder, MPEG-4 Part 2 takes its place. The
/// file is written beside its name and put there by finish(); until then, and if finish() is never
/// reached, a file that stood there stays.
class VideoWriter {
  public:
    /// Throws Error if the extension, the size or the folder cannot be used.
    VideoWriter(std::filesystem::path path, const VideoSettings& settings);
    ~VideoWriter();
    VideoWriter(const VideoWriter&) = delete;
    VideoWriter& operator=(const VideoWriter&) = delete;

    /// Takes the picture that is shown from `time` on, counted from the start of the film and later
    /// than the picture's before it. Times are kept to 1/90000 s (Matroska stores milliseconds).
    /// Throws Error if the disk or the encoder fails.
    ///
    /// `timecode` is the film's at its start, as TimecodeClock writes it, or empty: the first
    /// picture's is kept, in Matroska as the stream's tag `timecode`, in MP4 as a time code track.
    void add(const ColourImage& picture, std::chrono::nanoseconds time,
             const std::string& timecode = {});

    /// Ends the film and puts the file in its place. Throws Error if the disk fails, or if no
    /// picture was added.
    void finish();

    /// After a failure, the last call: puts what was written until then in its place, if it can be
    /// read. False: it cannot, and a file that stood there stays.
    bool keep_what_is_written() noexcept;

    std::uint64_t frames() const { return frames_; }
    std::string codec_name() const;

  private:
    void open_encoder(const VideoSettings& settings);
    void open_file();
    void begin(const std::string& timecode);
    void drain();
    [[noreturn]] void fail_writing(int code) const;

    std::filesystem::path path_, partial_;
    AvOutputPtr output_;
    AvCodecContextPtr encoder_;
    SwsContextPtr to_yuv_;
    AvFramePtr frame_;
    AvPacketPtr packet_;
    AVStream* stream_ = nullptr;  ///< owned by output_
    std::uint64_t frames_ = 0;
    std::int64_t last_pts_ = -1;
    bool has_begun_ = false, is_ended_ = false, finished_ = false;
};

}  // namespace vantage

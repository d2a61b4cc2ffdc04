#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "common/av/av_handles.h"
#include "common/image/image.h"
#include "host_app/output/disk_sync.h"
#include "host_app/output/picture_encoder.h"

namespace vantage {

struct VideoSettings {
    int width_px = 0, height_px = 0;  ///< of the pictures; an odd last row or column is left out
    double rate_hz = 30;              ///< 29.97 and its like are n * 1000 / 1001
    double quality = 20;              ///< x264's constant rate factor, 0 (lossless) .. 51
    std::optional<std::int64_t> bit_rate_bps = {};  ///< nothing: what the quality needs
    std::string encoder = "libx264";                ///< one of known_encoders()
};

/// Throws Error if no film has such a name.
void require_film_name(const std::filesystem::path& path);

/// Writes a video file, H.264 in Matroska or MP4 by the path's extension (.mkv, .mp4), colours by
/// ITU-R BT.709. The file is written beside its name and put there by finish(); until then, and if
/// finish() is never reached, a file that stood there stays. A power cut leaves what was written
/// until a second or two before beside its name, and it opens.
class VideoWriter {
  public:
    /// Throws Error if the extension, the size or the folder cannot be used.
    VideoWriter(std::filesystem::path path, const VideoSettings& settings);
    ~VideoWriter();
    VideoWriter(const VideoWriter&) = delete;
    VideoWriter& operator=(const VideoWriter&) = delete;

    /// Takes the picture that is shown from tick / rate on, counted from the start of the film;
    /// ticks grow (Matroska stores milliseconds). Throws Error if the disk or the encoder fails.
    ///
    /// `timecode` is the film's at its start, as TimecodeClock writes it, or empty: the first
    /// picture's is kept, in Matroska as the stream's tag `timecode`, in MP4 as a time code track.
    void add(const ColourImage& picture, std::int64_t tick, const std::string& timecode = {});

    /// Ends the film and puts the file in its place. Throws Error if the disk fails, or if no
    /// picture was added.
    void finish();

    /// After a failure, the last call: puts what was written until then in its place, if it can be
    /// read. False: it cannot, and a file that stood there stays.
    bool keep_what_is_written() noexcept;

    std::uint64_t frames() const { return frames_; }
    /// Written to the file so far; what the muxer holds back is not in it.
    std::uint64_t bytes() const { return bytes_; }

  private:
    void open_file();
    void begin(const std::string& timecode);
    void drain();
    [[noreturn]] void fail_writing(int code) const;

    std::filesystem::path path_, partial_;
    AvOutputPtr output_;
    std::optional<PictureEncoder> encoder_;
    std::optional<DiskSync> sync_;
    AVStream* stream_ = nullptr;  ///< owned by output_
    std::uint64_t frames_ = 0, bytes_ = 0;
    std::int64_t last_tick_ = -1;
    bool has_begun_ = false, is_ended_ = false, finished_ = false;
};

}  // namespace vantage

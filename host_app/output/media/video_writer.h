#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "common/image/image.h"
#include "host_app/output/media/film_file.h"
#include "host_app/output/media/picture_encoder.h"
#include "host_app/output/media/sound_encoder.h"

namespace vantage {

struct VideoSettings {
    int width_px = 0, height_px = 0;  ///< of the frames; an odd last row or column is cropped
    double rate_hz = 30;              ///< 29.97 and similar rates are n * 1000 / 1001
    double quality = 20;              ///< x264's constant rate factor, 0 (lossless) .. 51
    std::optional<std::int64_t> bit_rate_bps = {};  ///< empty: whatever the quality needs
    std::string encoder = "libx264";                ///< one of known_encoders()
    bool has_sound = false;
};

/// Writer of a film: encodes frames as H.264 in ITU-R BT.709 into a FilmFile. Not thread-safe.
class VideoWriter {
  public:
    /// Throws Error if the extension, the size or the folder cannot be used.
    VideoWriter(std::filesystem::path path, const VideoSettings& settings);

    /// Adds the frame with the time tick / rate since the start of the film; ticks ascend (Matroska
    /// stores milliseconds). Throws Error if the disk or the encoder fails.
    ///
    /// `timecode` of the first frame becomes that of the film.
    void add(const ColourImage& picture, std::int64_t tick, const std::string& timecode = {});

    /// Adds the sound of a tick, in ascending order, if the settings include sound. Throws like
    /// add(). Precondition: a frame was added.
    void hear(const SoundBlock& sound, std::int64_t tick);

    /// Completes the film and renames it to its final name. Throws Error if the disk fails, or if
    /// no frame was added.
    void finish();

    /// See FilmFile.
    bool keep_what_is_written() noexcept { return file_.keep_what_is_written(); }

    std::uint64_t frames() const { return frames_; }
    /// See FilmFile.
    std::uint64_t bytes() const { return file_.bytes(); }

  private:
    void drain();

    FilmFile file_;
    std::optional<PictureEncoder> encoder_;
    std::optional<SoundTrack> sound_;
    std::uint64_t frames_ = 0;
    std::int64_t last_tick_ = -1;
};

}  // namespace vantage

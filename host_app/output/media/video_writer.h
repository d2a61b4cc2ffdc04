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
    int width_px = 0, height_px = 0;  ///< of the pictures; an odd last row or column is left out
    double rate_hz = 30;              ///< 29.97 and its like are n * 1000 / 1001
    double quality = 20;              ///< x264's constant rate factor, 0 (lossless) .. 51
    std::optional<std::int64_t> bit_rate_bps = {};  ///< nothing: what the quality needs
    std::string encoder = "libx264";                ///< one of known_encoders()
    bool has_sound = false;
};

/// Encodes pictures as H.264, colours by ITU-R BT.709, into a FilmFile.
class VideoWriter {
  public:
    /// Throws Error if the extension, the size or the folder cannot be used.
    VideoWriter(std::filesystem::path path, const VideoSettings& settings);

    /// Takes the picture that is shown from tick / rate on, counted from the start of the film;
    /// ticks grow (Matroska stores milliseconds). Throws Error if the disk or the encoder fails.
    ///
    /// `timecode` is the film's at its start: the first picture's is kept.
    void add(const ColourImage& picture, std::int64_t tick, const std::string& timecode = {});

    /// Sound of that tick, in their order, where the settings say that there is any. Throws Error
    /// likewise. Precondition: a picture was added.
    void hear(const SoundBlock& sound, std::int64_t tick);

    /// Ends the film and puts the file in its place. Throws Error if the disk fails, or if no
    /// picture was added.
    void finish();

    /// As FilmFile's.
    bool keep_what_is_written() noexcept { return file_.keep_what_is_written(); }

    std::uint64_t frames() const { return frames_; }
    /// As FilmFile's.
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

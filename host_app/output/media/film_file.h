#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include "common/av/av_handles.h"
#include "common/base/files/unique_fd.h"
#include "common/image/image.h"
#include "host_app/output/media/picture_encoder.h"
#include "host_app/output/media/sound_encoder.h"

namespace vantage {

/// Flushes a file to its disk once a second on a thread of its own. A power cut then loses about
/// one second, and the writer never waits for the disk.
class DiskSync {
  public:
    /// The file must exist.
    explicit DiskSync(const std::filesystem::path& path);

    /// Flushes the file now and waits for it.
    void now();
    /// errno of a failed flush; 0: none. write() may still succeed in the meantime, until memory or
    /// the file system is full.
    int failure() const { return failure_; }

  private:
    UniqueFd fd_;
    std::atomic<int> failure_ = 0;
    std::jthread thread_;
};

/// Throws Error if the name has no extension of a film.
void require_film_name(const std::filesystem::path& path);

/// Writer of a film file, Matroska or MP4 by its extension (.mkv, .mp4), for encoded packets. It
/// writes to a temporary name, and finish() renames the file; without finish() an existing file
/// stays. After a power cut the temporary file holds everything up to the last one or two seconds,
/// and it opens.
class FilmFile {
  public:
    /// Throws Error if the extension is not supported.
    explicit FilmFile(std::filesystem::path path);
    ~FilmFile();
    FilmFile(const FilmFile&) = delete;
    FilmFile& operator=(const FilmFile&) = delete;

    const std::filesystem::path& path() const { return path_; }
    /// Sound codec for this kind of file. All players can read AAC in MP4, but not every other
    /// codec.
    SoundEncoder::Codec sound_codec() const;
    /// True if the container stores the codec's header once, at its start.
    bool has_head() const;

    /// Opens the file for packets with these parameters and time base. Throws Error if the folder
    /// cannot be used.
    /// `sound`: its times are in samples; null if the film has none.
    void open(const AVCodecParameters& pictures, AVRational time_base, AVRational rate,
              const AVCodecParameters* sound = nullptr);
    /// Sets the time code at the start of the film, as TimecodeClock formats it, or empty. Call it
    /// after open() and before the first packet. Matroska stores it as the stream's tag `timecode`,
    /// MP4 as a time code track. The name of the file is the reel's name.
    void begin(const std::string& timecode);
    bool has_begun() const { return has_begun_; }
    /// Writes a packet and takes its content. Packets come in decoding order. Throws Error if the
    /// disk fails.
    void write(AVPacket& packet);
    void write_sound(AVPacket& packet);
    /// Completes the film and renames it to its final name. Throws Error if the disk fails.
    void finish();

    /// Call it last, after a failure: renames the file to its final name if it can be read. Returns
    /// false if it cannot; an existing file then stays.
    bool keep_what_is_written() noexcept;

    /// Bytes written so far, without those that the muxer buffers.
    std::uint64_t bytes() const { return bytes_; }

  private:
    AVStream& add_stream(const AVCodecParameters& parameters, AVRational time_base);
    void write(AVPacket& packet, AVRational time_base, const AVStream& stream);
    void require_disk() const;
    [[noreturn]] void fail_writing(int code) const;

    std::filesystem::path path_, partial_;
    AvOutputPtr output_;
    std::optional<DiskSync> sync_;
    AVStream* stream_ = nullptr;  ///< owned by output_
    AVStream* sound_ = nullptr;   ///< owned by output_; null: no sound
    AVRational time_base_{1, 1};
    std::uint64_t bytes_ = 0;
    bool has_begun_ = false, is_ended_ = false, finished_ = false;
};

/// Removes an incomplete fragment at the end of a fragmented MP4 file, since players fail on an
/// incomplete frame. Throws Error if the file cannot be read or cut.
void cut_to_whole_fragments(const std::filesystem::path& path);

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

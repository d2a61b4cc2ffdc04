#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "common/av/av_handles.h"
#include "host_app/output/media/disk_sync.h"
#include "host_app/output/media/sound_encoder.h"

namespace vantage {

/// Throws Error if no film has such a name.
void require_film_name(const std::filesystem::path& path);

/// A film's file, Matroska or MP4 by the path's extension (.mkv, .mp4), into which coded pictures
/// go. It is written beside its name and put there by finish(); until then, and if finish() is
/// never reached, a file that stood there stays. A power cut leaves what was written until a second
/// or two before beside its name, and it opens.
class FilmFile {
  public:
    /// Throws Error if the extension cannot be used.
    explicit FilmFile(std::filesystem::path path);
    ~FilmFile();
    FilmFile(const FilmFile&) = delete;
    FilmFile& operator=(const FilmFile&) = delete;

    const std::filesystem::path& path() const { return path_; }
    /// What sound a file of this kind has: MP4 is read everywhere with AAC only.
    SoundEncoder::Codec sound_codec() const;
    /// Whether the stream has its head once, at its beginning.
    bool has_head() const;

    /// What the packets are of, and in what their times are. Throws Error if the folder cannot be
    /// used.
    /// `sound`: with times in samples; null: the film has none.
    void open(const AVCodecParameters& pictures, AVRational time_base, AVRational rate,
              const AVCodecParameters* sound = nullptr);
    /// After open(), before the first packet: the time code that the film begins with, as
    /// TimecodeClock writes it, or empty. Kept in Matroska as the stream's tag `timecode`, in MP4
    /// as a time code track.
    void begin(const std::string& timecode);
    bool has_begun() const { return has_begun_; }
    /// In the order of decoding; what the packet holds is taken. Throws Error if the disk fails.
    void write(AVPacket& packet);
    void write_sound(AVPacket& packet);
    /// Ends the film and puts the file in its place. Throws Error if the disk fails.
    void finish();

    /// After a failure, the last call: puts what was written until then in its place, if it can be
    /// read. False: it cannot, and a file that stood there stays.
    bool keep_what_is_written() noexcept;

    /// Written so far; what the muxer holds back is not in it.
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
    AVStream* sound_ = nullptr;   ///< likewise; null: none
    AVRational time_base_{1, 1};
    std::uint64_t bytes_ = 0;
    bool has_begun_ = false, is_ended_ = false, finished_ = false;
};

}  // namespace vantage

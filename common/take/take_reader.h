#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/take/format/ebml_file.h"
#include "common/take/format/take_format.h"
#include "common/take/take_writer.h"

namespace vantage {

/// Data of a take differs from what was written.
class TakeDamaged : public Error {
  public:
    using Error::Error;
};

/// A damaged place in a take.
struct TakeDamage {
    std::uint64_t at = 0;  ///< offset in the file in bytes
    std::string words;
};

/// Reads a take, also one that is truncated or damaged in places. Opening reads the heads of its
/// blocks and the records of its frames, but no images. Afterwards every call is thread-safe.
class TakeReader {
  public:
    /// Throws Error if it is not a take, or its head is damaged.
    explicit TakeReader(std::filesystem::path path);

    struct Block {
        std::uint64_t at = 0;
        std::uint32_t size = 0;  ///< 0: none
    };
    struct Frame {
        std::uint64_t pulse = 0, gap = 0, dropped = 0, session = 0;
        TaiTime exposure{};
        std::int64_t time_ms = 0;
        Block record, colour, depth;
        std::optional<std::uint32_t> colour_crc, depth_crc;
        RigCounters rig;
        LinkCounters link;
    };

    struct Sound {
        std::int64_t first = 0;   ///< number of the first sample
        std::uint32_t count = 0;  ///< number of samples
        Block record, samples;
        std::uint32_t crc = 0;
        std::int64_t end() const { return first + count; }
    };

    const std::filesystem::path& path() const { return path_; }
    const TakeFacts& facts() const { return facts_; }
    std::uint64_t bytes() const { return file_.size(); }
    /// The frames of facts().rigs[rig], in the order of their pulses.
    const std::vector<Frame>& frames(std::size_t rig) const { return frames_[rig]; }
    /// The camera of every tick, in order.
    const std::vector<CameraRecord>& cameras() const { return cameras_; }
    /// The sound in order of time; no sample occurs twice.
    const std::vector<Sound>& sounds() const { return sounds_; }
    /// The damage that opening found.
    const std::vector<TakeDamage>& damage() const { return damage_; }
    /// Whether the writer finished the file.
    bool is_ended() const { return is_ended_; }
    /// From the first to the last frame.
    double duration_s() const;

    /// Loads a frame with all its data. Throws TakeDamaged if a checksum does not match.
    StoredFrame load(std::size_t rig, const Frame& frame) const;
    /// Loads a block of sound in its stored form. Throws TakeDamaged, too.
    std::vector<std::byte> load(const Sound& sound) const;

  private:
    struct Track {
        enum class Kind {
            none,
            colour,
            depth,
            record,
            camera,
            sound,
            sound_record
        } kind = Kind::none;
        std::size_t rig = 0;
    };
    struct HeadTrack;
    void read_head();
    void read_tracks(const EbmlFile::Element& tracks, std::vector<HeadTrack>& found);
    void read_attachments(const EbmlFile::Element& attachments);
    void name_tracks(const std::vector<HeadTrack>& found);
    void read_clusters(std::uint64_t at);
    void read_cluster(const EbmlFile::Element& cluster);
    void take_block(std::uint64_t at, std::uint64_t end, std::int64_t cluster_ms);
    void take_record(std::size_t rig, std::int64_t time_ms, const Block& block);
    void take_sound_record(std::int64_t time_ms, const Block& block);
    void take_sound(std::uint64_t at, std::int64_t time_ms, const Block& block);
    void sort_frames();
    void sort_sounds();
    void add_damage(std::uint64_t at, std::string words);

    std::filesystem::path path_;
    EbmlFile file_;
    TakeFacts facts_;
    std::map<std::uint64_t, Track> tracks_;  ///< by Matroska's track number
    std::vector<std::vector<Frame>> frames_;
    std::vector<CameraRecord> cameras_;
    std::vector<Sound> sounds_;
    std::vector<TakeDamage> damage_;
    std::uint64_t segment_begin_ = 0, segment_end_ = 0;
    bool is_ended_ = false;
};

}  // namespace vantage

#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/av/av_handles.h"
#include "common/take/format/take_format.h"

namespace vantage {

class TakeFile;

/// A frame in a take's form: encoded images, which are never encoded again.
struct StoredFrame {
    FrameRecord record;
    std::vector<std::byte> colour, depth;  ///< empty: the frame has none
};

/// Writes a take. The file has its final name from the start. Data that was handed over survives
/// the end of the program, and is on disk half a second later, so that a power cut leaves a file
/// that can be opened and lacks at most the last half second. Not thread-safe.
class TakeWriter {
  public:
    /// Throws Error if the file exists or cannot be created.
    TakeWriter(std::filesystem::path path, TakeFacts facts);
    ~TakeWriter();
    TakeWriter(const TakeWriter&) = delete;
    TakeWriter& operator=(const TakeWriter&) = delete;

    /// Adds a frame and fills in record.gap and the CRCs. Its time is its pulse's, or its
    /// exposure's if it has no pulse. Throws Error if the disk fails; the file can still be opened.
    /// False: the frame is before the take, or not later than the rig's frame before it.
    bool add(std::size_t rig, StoredFrame frame);
    /// False: the tick is before the take.
    bool add(const CameraRecord& camera);

    /// Adds sound. Samples before the take, and samples that were added already, are skipped.
    /// False: all were skipped. Precondition: facts().has_sound.
    bool add(const SoundBlock& sound);
    /// Adds sound in the stored form of another take.
    bool add_sound(std::int64_t first, std::span<const std::byte> stored);

    /// Passes all data to the system, so that it survives the end of the program.
    void hand_over();
    /// Hands over data older than half a second and syncs it to disk. Call it often.
    void flush_if_due();
    /// Writes the index and closes the file. Throws Error if the disk fails; the file can still be
    /// opened.
    void finish();

    const std::filesystem::path& path() const { return path_; }
    const TakeFacts& facts() const { return facts_; }
    std::uint64_t bytes() const;
    std::uint64_t frames() const { return frames_; }
    std::uint64_t gaps() const { return gaps_; }
    double sound_s() const { return static_cast<double>(sound_samples_) / sound_rate_hz; }
    /// When the sync began that runs on another thread; empty: none runs.
    std::optional<MonotonicTime> syncing_since() const;
    /// From the first to the last frame.
    double duration_s() const;

  private:
    struct Tracks {
        int colour = -1, depth = -1, record = -1;
        std::optional<std::uint64_t> last_pulse;
        std::optional<std::int64_t> last_ms;
    };
    void open();
    int add_pictures(const TakePictures& pictures, const std::string& title);
    int add_text(const std::string& title);
    int add_sound_track();
    void attach(const TakeAttachment& attachment);
    void write(int track, std::int64_t time_ms, std::span<const std::byte> bytes);
    void flush();
    void sync_if_due();
    [[noreturn]] void fail_writing(int code);

    std::filesystem::path path_;
    TakeFacts facts_;
    std::int64_t duration_ms_;  ///< of a block
    std::unique_ptr<TakeFile> file_;
    AvOutputPtr output_;
    AvPacketPtr packet_;
    std::vector<Tracks> tracks_;
    int camera_track_ = -1;
    std::optional<std::int64_t> last_camera_ms_;
    int sound_track_ = -1, sound_record_track_ = -1;
    std::int64_t next_sound_ = 0;  ///< first sample that is neither added nor before the take
    std::uint64_t sound_samples_ = 0;
    std::uint64_t frames_ = 0, gaps_ = 0;
    std::int64_t first_ms_ = 0, last_ms_ = 0;
    std::optional<std::int64_t> unwritten_ms_;  ///< time of the first data not handed over
    MonotonicTime unwritten_since_{};
    bool is_unsynced_ = false;  ///< data was handed over since the last sync
    MonotonicTime synced_at_{};
    bool is_finished_ = false;
};

/// Throws Error if no take can be created: no such folder, an ending other than .mkv, or the file
/// exists. `done` completes the sentence "PATH cannot be ...": "recorded".
void require_new_take(const std::filesystem::path& path, const char* done);

}  // namespace vantage

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

/// A frame as a take keeps it: coded pictures, which are never coded a second time.
struct StoredFrame {
    FrameRecord record;
    std::vector<std::byte> colour, depth;  ///< empty: the frame has none
};

/// Writes a take. The file stands under its own name from the start. What is handed over outlives
/// the program, and is on the disk half a second later: what ends the computer leaves a file that
/// opens, but for that half second. Not thread-safe.
class TakeWriter {
  public:
    /// Throws Error if there is such a file already, or none can be made there.
    TakeWriter(std::filesystem::path path, TakeFacts facts);
    ~TakeWriter();
    TakeWriter(const TakeWriter&) = delete;
    TakeWriter& operator=(const TakeWriter&) = delete;

    /// Fills in record.gap and the CRCs. The frame's time is its pulse's; one that names none has
    /// that of its exposure. Throws Error if the disk fails: what is written by then opens.
    /// False: the frame is before the take, or not later than the rig's frame before it.
    bool add(std::size_t rig, StoredFrame frame);
    /// False: the tick is before the take.
    bool add(const CameraRecord& camera);

    /// Samples before the take, and those that are there already, are left out. False: all are.
    /// Precondition: facts().has_sound.
    bool add(const SoundBlock& sound);
    /// The same, as another take holds it.
    bool add_sound(std::int64_t first, std::span<const std::byte> stored);

    /// Gives the system all that was added: a program that is killed loses nothing of it.
    void hand_over();
    /// Does so with what was kept back for half a second, and has the disk follow. To be called
    /// often.
    void flush_if_due();
    /// Writes the index and closes. Throws Error if the disk fails; the file opens all the same.
    void finish();

    const std::filesystem::path& path() const { return path_; }
    const TakeFacts& facts() const { return facts_; }
    std::uint64_t bytes() const;
    std::uint64_t frames() const { return frames_; }
    std::uint64_t gaps() const { return gaps_; }
    double sound_s() const { return static_cast<double>(sound_samples_) / sound_rate_hz; }
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
    std::int64_t next_sound_ = 0;  ///< sample; those before are there, or before the take
    std::uint64_t sound_samples_ = 0;
    std::uint64_t frames_ = 0, gaps_ = 0;
    std::int64_t first_ms_ = 0, last_ms_ = 0;
    std::optional<std::int64_t> unwritten_ms_;  ///< time of the first that may not be on the disk
    MonotonicTime unwritten_since_{};
    bool is_unsynced_ = false;  ///< the system has what the disk may not have
    MonotonicTime synced_at_{};
    bool is_finished_ = false;
};

/// Throws Error if no take can be made there: no such folder, another ending than .mkv, or a file
/// that is there. `done` says in the error what is not: "recorded".
void require_new_take(const std::filesystem::path& path, const char* done);

}  // namespace vantage

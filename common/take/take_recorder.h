#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/take/format/frame_storage.h"
#include "common/take/take_writer.h"
#include "common/wire/arrived_frame.h"

namespace vantage {

/// Measures the write rate of a folder's disk in MB/s, including the sync, by writing for at most
/// 0.3 s. Throws Error if the folder is not writable.
double measure_disk_mb_s(const std::filesystem::path& folder);
/// Free space on the folder's disk in MB.
double free_disk_mb(const std::filesystem::path& folder);

/// The phase of the recording.
enum class TakePhase {
    none,     ///< no take yet
    opening,  ///< waits for the rigs' first frames and measures the disk
    recording,
    failed  ///< `failure` has the reason
};

/// The state of the recording, for the desk and the summary.
struct TakeState {
    TakePhase phase = TakePhase::none;
    std::string path;     ///< of the current or last take; empty: none
    std::string failure;  ///< one sentence; empty: none
    std::string trouble;  ///< one sentence while data reaches the disk late; empty: none
    std::uint64_t frames = 0, gaps = 0, bytes = 0;
    double duration_s = 0;
    double mb_s = 0;       ///< data rate of the take
    double disk_mb_s = 0;  ///< write rate of the disk
    /// The longest time that a frame was in memory only: the most that a killed program would lose.
    double longest_unwritten_ms = 0;
    struct Rig {
        std::string name;
        std::uint64_t frames = 0;
        std::uint64_t dropped = 0;  ///< came while the disk or the processor was too slow
        std::uint64_t refused = 0;  ///< damaged, out of order, or not fitting the tracks
    };
    std::vector<Rig> rigs;
    bool has_sound = false;
    double sound_s = 0;               ///< sound in the take
    std::uint64_t sound_dropped = 0;  ///< samples that came while the disk was too slow
    std::uint64_t takes = 0;          ///< number of takes begun
};

/// Records the rigs' frames on a thread of its own, independently of the programme. If data comes
/// faster than it can be written, the oldest frames are dropped and counted, and the take has a
/// gap. Thread-safe.
class TakeRecorder {
  public:
    struct Settings {
        std::vector<std::string> rigs;  ///< in the order of stage.toml
        double pulse_rate_hz = 30;
        std::string program;
        nlohmann::ordered_json show;  ///< for TakeFacts::show
        std::vector<TakeAttachment> attachments = {};
        bool has_sound = false;
        std::chrono::nanoseconds pre_roll{0};   ///< time before the request that a take includes
        std::size_t queue_bytes = 256'000'000;  ///< data that may wait to be written
        /// How long the start of the file waits for rigs that have not sent yet.
        std::chrono::milliseconds rig_wait{500};
        bool may_be_empty = false;  ///< whether a take without frames is no failure
        std::function<double(const std::filesystem::path&)> disk_mb_s = measure_disk_mb_s;
    };
    /// The part of the settings that follows a changed stage.
    struct Stage {
        std::vector<std::string> rigs;      ///< names by number, see ArrivedFrame::rig
        std::vector<std::size_t> recorded;  ///< numbers of the rigs that takes have, in their order
        nlohmann::ordered_json show;
        std::vector<TakeAttachment> attachments = {};
    };

    explicit TakeRecorder(Settings settings);
    /// Ends the current take.
    ~TakeRecorder();
    TakeRecorder(const TakeRecorder&) = delete;
    TakeRecorder& operator=(const TakeRecorder&) = delete;

    /// Uses this stage for takes that begin from now on. A current take keeps its rigs: frames of
    /// others are refused and counted. Numbers of rigs keep their names.
    void change_stage(Stage stage);

    /// Never blocks.
    void offer(const ArrivedFrame& frame);
    void offer(const CameraRecord& camera, MonotonicTime now = MonotonicClock::now());
    /// Adds sound in the order in which it was heard. Precondition: Settings::has_sound.
    void offer(const SoundBlock& sound);

    /// Begins a take, `pre_roll` ago; a current take continues. Throws Error if the file exists,
    /// its folder does not, or an ended take is still being written. Whether the disk is fast
    /// enough shows in the state.
    void begin(const std::filesystem::path& path);
    /// Ends the current take: what came so far is written, on the recorder's thread.
    void end();
    /// Ends the current take and waits until it is written.
    void finish();
    bool is_running() const;

    TakeState state() const;
    /// The current size and duration of the frames kept for a pre-roll.
    struct PreRoll {
        std::size_t bytes = 0;
        double seconds = 0;
    };
    PreRoll pre_roll() const;

  private:
    struct Item {
        std::optional<ArrivedFrame> frame;
        CameraRecord camera;
        std::shared_ptr<const SoundBlock> sound;  ///< null: another kind of item
        MonotonicTime arrival{};
        std::size_t bytes() const;
    };
    /// A take in progress; used by the thread only.
    struct Take;
    class Writing;

    void run();
    void push(Item item);
    std::size_t row_of(std::size_t rig);
    void offer_with_pre_roll(Item item);
    std::vector<Item> pop_some();
    void work(Take& take, std::vector<Item> items);
    void look_at_first(Take& take, const Item& item);
    void open_if_ready(Take& take);
    void open(Take& take);
    void store(Take& take, std::span<const Item> items);
    void write(Take& take, const ArrivedFrame& frame, StoredFrame stored);
    void hear(Take& take, const SoundBlock& sound);
    void write_sound(Take& take);
    void refuse(Take& take, const ArrivedFrame& frame, const std::string& why);
    void close(Take& take);
    void note(Take& take);
    bool is_disk_slow(MonotonicTime now) const;
    std::string trouble(MonotonicTime now) const;

    const Settings settings_;   ///< `stage_` replaces its rigs, its show and its attachments
    mutable std::mutex mutex_;  ///< guards the members below; never held during a write or codec
    std::condition_variable woken_, idle_;
    std::deque<Item> queue_, pre_roll_;
    std::size_t queued_bytes_ = 0, pre_roll_bytes_ = 0, most_queued_bytes_ = 0;
    std::optional<std::filesystem::path> begin_;  ///< requested, but not begun yet
    bool is_taking_ = false, is_ending_ = false, is_stopping_ = false;
    Stage stage_;
    /// Rows of state_.rigs by the rigs' numbers; the first ones are the take's tracks.
    std::map<std::size_t, std::size_t> rows_;
    std::size_t tracks_ = 0;
    TakeState state_;
    /// The thread's present round: its start, the arrival of its oldest data, the writer's call
    /// that it is in, and the time in such calls.
    MonotonicTime round_began_{};
    std::optional<MonotonicTime> round_arrival_, writing_since_;
    std::chrono::nanoseconds round_writing_{0};
    std::optional<MonotonicTime> syncing_since_;  ///< start of the sync that runs
    MonotonicTime asked_{};                       ///< for the take
    std::thread thread_;
};

}  // namespace vantage

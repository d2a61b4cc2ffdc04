#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/take/disk_benchmark.h"
#include "common/take/format/frame_storage.h"
#include "common/take/take_writer.h"
#include "common/wire/arrived_frame.h"

namespace vantage {

enum class TakePhase {
    none,     ///< nothing is recorded
    opening,  ///< waits for the rigs' first frames and measures the disk
    recording,
    failed  ///< `failure` says why
};

/// How the recording stands, for the desk and the summary.
struct TakeState {
    TakePhase phase = TakePhase::none;
    std::string path;     ///< of the take that runs or was the last; empty: there was none
    std::string failure;  ///< one sentence; empty: none
    std::uint64_t frames = 0, gaps = 0, bytes = 0;
    double duration_s = 0;
    double mb_s = 0;       ///< that are written
    double disk_mb_s = 0;  ///< that the disk takes
    /// The most that a frame was in memory only: what a killed program would have lost at worst.
    double longest_unwritten_ms = 0;
    struct Rig {
        std::string name;
        std::uint64_t frames = 0;
        std::uint64_t dropped = 0;  ///< came while the disk or the processor could not follow
        std::uint64_t refused = 0;  ///< fit no track, or came out of order, or were damaged
    };
    std::vector<Rig> rigs;
    bool has_sound = false;
    double sound_s = 0;               ///< that is in it
    std::uint64_t sound_dropped = 0;  ///< samples that came while the disk could not follow
    std::uint64_t takes = 0;          ///< that were begun
};

/// Records what the rigs send, whatever the programme does, on a thread of its own. What comes
/// faster than it can be written is dropped, the oldest first, counted, and a gap in the take.
/// Thread-safe.
class TakeRecorder {
  public:
    struct Settings {
        std::vector<std::string> rigs;  ///< of the stage, in its order
        double pulse_rate_hz = 30;
        std::string program;
        nlohmann::ordered_json show;  ///< TakeFacts::show
        std::vector<TakeAttachment> attachments = {};
        bool has_sound = false;
        std::chrono::nanoseconds pre_roll{0};   ///< that a take begins before it is asked for
        std::size_t queue_bytes = 256'000'000;  ///< that may wait to be written
        /// For rigs that have not sent yet. Until then nothing is written.
        std::chrono::milliseconds rig_wait{500};
        bool may_be_empty = false;  ///< a take that no frame came for is no failure
        std::function<double(const std::filesystem::path&)> disk_mb_s = measure_disk_mb_s;
    };
    explicit TakeRecorder(Settings settings);
    /// Ends the take that runs.
    ~TakeRecorder();
    TakeRecorder(const TakeRecorder&) = delete;
    TakeRecorder& operator=(const TakeRecorder&) = delete;

    /// Never wait.
    void offer(const ArrivedFrame& frame);
    void offer(const CameraRecord& camera, MonotonicTime now = MonotonicClock::now());
    /// What was heard, in its order. Precondition: Settings::has_sound.
    void offer(const SoundBlock& sound);

    /// Begins a take, `pre_roll` ago; one that runs goes on. Throws Error if there is such a file,
    /// or no folder for it, or while one that was ended is still being written. Whether the disk is
    /// fast enough shows in the state.
    void begin(const std::filesystem::path& path);
    /// Ends the one that runs: what came until now is written, on the recorder's thread.
    void end();
    /// Ends it and waits until it is written.
    void finish();
    bool is_running() const;

    TakeState state() const;
    /// What the frames that may become a pre-roll take now, and of how much time they are.
    struct PreRoll {
        std::size_t bytes = 0;
        double seconds = 0;
    };
    PreRoll pre_roll() const;

  private:
    struct Item {
        std::optional<ArrivedFrame> frame;
        CameraRecord camera;
        std::shared_ptr<const SoundBlock> sound;  ///< null: it is another item
        MonotonicTime arrival{};
        std::size_t bytes() const;
    };
    /// A take on its way; of the thread.
    struct Take;

    void run();
    void push(Item item);
    void offer_with_pre_roll(Item item);
    std::vector<Item> pop_some();
    void work(Take& take, std::vector<Item> items);
    void look_at_first(Take& take, const Item& item);
    void open_if_ready(Take& take);
    void open(Take& take);
    void store(Take& take, std::span<const Item> items);
    void write(Take& take, const ArrivedFrame& frame, StoredFrame stored);
    void hear(Take& take, const SoundBlock& sound);
    static void write_sound(Take& take);
    void refuse(Take& take, const ArrivedFrame& frame, const std::string& why);
    void close(Take& take);
    void note(const Take& take);

    const Settings settings_;
    mutable std::mutex mutex_;  ///< of what follows; never held over a write or a codec
    std::condition_variable woken_, idle_;
    std::deque<Item> queue_, pre_roll_;
    std::size_t queued_bytes_ = 0, pre_roll_bytes_ = 0, most_queued_bytes_ = 0;
    std::optional<std::filesystem::path> begin_;  ///< asked for, not begun yet
    bool is_taking_ = false, is_ending_ = false, is_stopping_ = false;
    TakeState state_;
    std::thread thread_;
};

}  // namespace vantage

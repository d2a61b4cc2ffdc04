#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "common/base/bounded_queue.h"
#include "common/base/percentiles.h"
#include "common/base/time/rate_meter.h"
#include "host_app/output/frame_set_timecode.h"
#include "host_app/output/output_target.h"
#include "host_app/output/picture_sink.h"

namespace vantage {

enum class OutputPhase {
    off,
    opening,
    waiting,  ///< for somebody who calls
    on,
    failed,  ///< a stream is tried again
};

/// How an output stands. Every picture that it was offered is written, dropped, unheard or queued.
struct OutputState {
    std::string name;
    std::string film = {};  ///< its file, where it is one
    OutputPhase phase = OutputPhase::off;
    std::string failure;         ///< why; of a stream that is on again: nothing
    std::string encoder;         ///< empty: its pictures are not encoded
    std::uint64_t offered = 0;   ///< pictures, while it was to run
    std::uint64_t pictures = 0;  ///< written
    std::uint64_t dropped = 0;   ///< since it was slow, or failed
    std::uint64_t unheard = 0;   ///< of a stream, while nobody took it
    std::uint64_t queued = 0;    ///< the one that is being written included
    bool has_sound = false;
    std::uint64_t silenced = 0;      ///< ticks whose sound was left out
    std::uint64_t bytes = 0;         ///< written
    std::uint64_t failures = 0;      ///< times that it failed
    std::uint64_t callers_left = 0;  ///< of one that listens
    double bit_rate_bps = 0;         ///< over the last two seconds
    Percentiles write_ms;            ///< encoding and writing, a picture
};

/// One output of the programme, on a thread of its own with a short queue, so that neither encoder
/// nor network nor disk ever holds up a tick. Where it cannot follow, the oldest waiting picture is
/// left out and counted; the others keep their times. One that fails does so alone; a stream is
/// tried again, ever later, ten seconds apart at the most.
class Output {
  public:
    /// Off. `pulse_rate_hz` is the stage's.
    Output(OutputPlan plan, const OutputFormat& format, double pulse_rate_hz);
    /// Without finish(), a file that is not ended is removed.
    ~Output();
    Output(const Output&) = delete;
    Output& operator=(const Output&) = delete;

    /// Never wait; from any thread. What was stopped may be started again; a film goes on in
    /// another file.
    void start();
    void stop();
    /// Shares the picture. Never waits, never throws.
    void take(const ProgrammePicture& picture);
    /// Ends it for good: what waits is written, within two seconds where that takes a peer.
    void finish();

    /// Whether it was told to run and not to stop.
    bool is_wanted() const;
    OutputState state() const;

  private:
    struct Item {
        ColourImage picture;
        std::uint64_t tick = 0;
        std::string timecode;
    };
    void run();
    /// From opening to its end or failure.
    void serve();
    void write(OutputTarget& target, const Item& item);
    /// That of ticks until this one.
    void hear(OutputTarget& target, std::uint64_t until);
    void want_no_more();
    void note_failure(const std::string& sentence);
    /// Of one that listens: the next caller is waited for.
    void note_caller_left();
    /// What waits is not written any more. Precondition: mutex_ is held.
    void drop_waiting();
    /// False: it is not wanted any more.
    bool wait_to_try_again(std::chrono::nanoseconds time);

    OutputPlan plan_;
    std::optional<SetTimecode> timecode_;  ///< of the programme's thread; none above 60 Hz
    BoundedQueue<Item> queue_;
    struct Sound {
        std::uint64_t tick = 0;
        std::shared_ptr<const SoundBlock> block;
    };
    /// A sound outlasts the picture that was left out: it is heard where that is not seen.
    std::deque<Sound> sounds_;
    std::size_t most_sounds_;
    OutputPatience patience_;
    std::optional<std::uint64_t> first_tick_;  ///< of the thread: since it was opened
    mutable std::mutex mutex_;
    std::condition_variable woken_;
    OutputState state_;
    RateMeter bytes_rate_;
    PercentileRecorder write_ms_;
    std::uint64_t bytes_before_ = 0;  ///< of what was opened before
    bool is_wanted_ = false, is_ending_ = false;
    bool is_due_ = false;  ///< to be opened, if only to write what already waits
    std::atomic<bool> is_abandoned_ = false;
    std::thread thread_;
};

/// For machines, such as "waiting".
const char* key_of(OutputPhase phase);
/// For people, such as "waiting for a caller".
const char* words_of(OutputPhase phase);

}  // namespace vantage

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
#include "host_app/output/output_target.h"
#include "host_app/output/picture_sink.h"

namespace vantage {

enum class OutputPhase {
    off,
    opening,
    waiting,  ///< for a caller
    on,
    failed,  ///< streams are tried again
};

/// State and counters of an output. Every offered frame is counted as written, dropped, unheard or
/// queued.
struct OutputState {
    std::string name;
    std::string film = {};  ///< path of its file, if it has one
    OutputPhase phase = OutputPhase::off;
    std::string failure;         ///< reason; empty for a stream that works again
    std::string encoder;         ///< empty if frames are not encoded
    std::uint64_t offered = 0;   ///< frames offered while the output was to run
    std::uint64_t pictures = 0;  ///< frames written
    std::uint64_t dropped = 0;   ///< frames lost while the output was slow or had failed
    std::uint64_t unheard = 0;   ///< frames of a stream while nobody received it
    std::uint64_t queued = 0;    ///< including the frame that is being written
    bool has_sound = false;
    std::uint64_t silenced = 0;      ///< ticks whose sound was dropped
    std::uint64_t bytes = 0;         ///< written
    std::uint64_t failures = 0;      ///< number of failures
    std::uint64_t callers_left = 0;  ///< callers that left a listening output
    double bit_rate_bps = 0;         ///< over the last two seconds
    Percentiles write_ms;            ///< time to encode and write one frame
};

/// One output of the programme, on a thread of its own with a short queue, so that encoder, network
/// and disk never delay a tick. If it cannot follow, the oldest waiting frame is dropped and
/// counted; the others keep their times. Its failure does not affect other outputs. A stream is
/// tried again at growing intervals of at most ten seconds.
class Output : private EncodedSink {
  public:
    /// Creates a stopped output. `pulse_rate_hz` is that of the stage.
    Output(OutputPlan plan, const OutputFormat& format, double pulse_rate_hz);
    /// Removes an incomplete file, unless finish() was called.
    ~Output() override;
    Output(const Output&) = delete;
    Output& operator=(const Output&) = delete;

    /// Start and stop the output. They never wait and may be called on any thread. An output can be
    /// started again after a stop; a film then continues in another file.
    void start();
    void stop();
    /// Queues a frame and shares its memory. Never waits, never throws.
    void take(const ProgrammePicture& picture);
    /// Ends the output for good. Waiting frames are written, to a peer within two seconds.
    void finish();

    /// True between start() and stop().
    bool is_wanted() const;
    OutputState state() const;

  private:
    struct Item {
        ColourImage picture;
        std::uint64_t tick = 0;
        std::string timecode;
        std::optional<EncodedPicture> encoded = {};  ///< instead of the picture
    };
    void run();
    /// Runs from opening until the end or a failure.
    void serve();
    /// Writes until the output is stopped.
    void write_all(OutputTarget& target);
    void write(OutputTarget& target, const Item& item);
    void take(const EncodedPicture& picture) override;
    void note_encoder_failure(const std::string& sentence) override;
    /// Queues an encoded frame that was offered here. Precondition: mutex_ is held.
    void deliver(const EncodedPicture& picture);
    /// Drops what waits until the next key frame. Precondition: mutex_ is held.
    void wait_for_key();
    /// Whether a frame that was offered is still with the encoder.
    bool is_being_encoded() const;
    /// Writes the sound of all ticks before `until`.
    void hear(OutputTarget& target, std::uint64_t until);
    void want_no_more();
    void note_failure(const std::string& sentence);
    /// For a listening output: counts the caller and waits for the next one.
    void note_caller_left();
    /// Drops the waiting frames. Precondition: mutex_ is held.
    void drop_waiting();
    /// Returns false if the output was stopped meanwhile.
    bool wait_to_try_again(std::chrono::nanoseconds time);

    OutputPlan plan_;
    std::optional<SetTimecode> timecode_;  ///< used by the programme's thread; empty above 60 Hz
    BoundedQueue<Item> queue_;
    struct Sound {
        std::uint64_t tick = 0;
        std::shared_ptr<const SoundBlock> block;
    };
    /// Sound stays in the queue when its frame is dropped, so that the sound has no gap.
    std::deque<Sound> sounds_;
    std::size_t most_sounds_;
    OutputPatience patience_;
    std::optional<std::uint64_t>
        first_tick_;  ///< used by the output's thread: first tick since opening
    mutable std::mutex mutex_;
    std::condition_variable woken_;
    OutputState state_;
    RateMeter bytes_rate_;
    PercentileRecorder write_ms_;
    std::uint64_t bytes_before_ = 0;      ///< of earlier openings
    std::deque<std::uint64_t> encoding_;  ///< ticks that the encoder has, of a plan with one
    std::deque<EncodedPicture> early_;    ///< encoded before they were offered here
    bool awaits_key_ = true;              ///< encoded frames are of no use until a key frame
    bool has_begun_ = false;              ///< an encoded frame was passed on since opening
    std::uint64_t next_number_ = 0;       ///< of the encoder's frames
    std::string encoder_failure_;         ///< since opening; empty: none
    bool is_wanted_ = false, is_ending_ = false;
    bool is_due_ = false;  ///< has to be opened, if only to write the waiting frames
    std::atomic<bool> is_abandoned_ = false;
    std::thread thread_;
};

/// Key for machines, e.g. "waiting".
const char* key_of(OutputPhase phase);
/// Text for operators, e.g. "waiting for a caller".
const char* words_of(OutputPhase phase);

}  // namespace vantage

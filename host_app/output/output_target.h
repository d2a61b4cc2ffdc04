#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/av/sound.h"
#include "common/base/error.h"
#include "common/base/time/time.h"
#include "common/image/image.h"
#include "host_app/output/media/shared_encoder.h"
#include "host_app/output/output_url.h"

namespace vantage {

/// Time for which an output may wait for its peer or device. Unlimited until the output is stopped.
class OutputPatience {
  public:
    bool is_over() const { return to_ns(MonotonicClock::now()) >= until_ns_; }
    void ends_after(std::chrono::nanoseconds time) {
        until_ns_ = to_ns(MonotonicClock::now() + time);
    }
    void is_endless() { until_ns_ = endless_ns; }

  private:
    static constexpr std::int64_t endless_ns = INT64_MAX;
    std::atomic<std::int64_t> until_ns_ = endless_ns;
};

class ScreenFeed;

/// Format of the programme, the same for all outputs.
struct OutputFormat {
    int width_px = 1280, height_px = 720;
    double rate_hz = 30;              ///< 29.97 and similar rates are n * 1000 / 1001
    std::string encoder = "libx264";  ///< one of known_encoders()
    bool overwrites = false;          ///< an existing file may be replaced
    bool has_sound = false;           ///< every tick has a SoundBlock
    /// Streams of equal settings share its encoders; null: each has its own.
    std::shared_ptr<EncoderPool> encoders = nullptr;
};

/// Error of a listening output whose caller has left. It ends the connection but does not count as
/// a failure.
class CallerLeft : public Error {
  public:
    using Error::Error;
};

/// Interface of an open output. Create, use and destroy it on the output's own thread, which may
/// block. If it is destroyed without finish(), it leaves nothing incomplete.
class OutputTarget {
  public:
    virtual ~OutputTarget() = default;
    /// Writes the frame of a tick. Ticks count from 0; those of dropped frames are missing.
    /// `timecode` may be empty. Throws Error if the target has failed.
    virtual void write(const ColourImage& picture, std::int64_t tick, const std::string& timecode);
    /// The same for targets of a plan with `encoder`, which get its frames. The first one is a key
    /// frame, and so is the first one after a gap.
    virtual void write_encoded(const EncodedPicture& picture, std::int64_t tick);
    /// Writes the sound of a tick, if the plan includes sound, in the order of ticks and right
    /// after its frame. The sound of a dropped frame comes before the next frame.
    virtual void hear(const SoundBlock& /*sound*/, std::int64_t /*tick*/) {}
    /// Called while no frame waits. A target without time stamps repeats a frame here for one
    /// dropped tick. Returns false if there is nothing to make up for. Throws like write().
    virtual bool catch_up() { return false; }
    /// Completes the output. Throws Error if it has failed.
    virtual void finish() {}
    /// Saves what can be saved after write() has failed. Returns an addition to the error message.
    virtual std::string salvage() { return ""; }
    /// Bytes written so far.
    virtual std::uint64_t bytes() const = 0;
};

/// Parsed and checked URL of an output, and the function that opens it.
struct OutputPlan {
    std::string name;       ///< for operators, without secrets
    std::string film = "";  ///< path of its file, if it has one
    bool begins = true;     ///< starts at once instead of on request
    bool is_stream =
        false;  ///< tried again after a failure; frames without a receiver are not lost frames
    bool takes_sound = false;
    bool is_listening = false;  ///< opening it waits for a caller
    bool is_encoded = true;
    std::shared_ptr<SharedEncoder> encoder = {};  ///< of a stream; null: the target encodes itself
    bool takes_stdout = false;
    std::shared_ptr<ScreenFeed> screen = {};  ///< feed for a monitor; null: none
    /// Waits until the target is open. Throws Error if it cannot be opened, or soon after
    /// `patience` is over, like write(). It may be called again once the previous target is
    /// destroyed.
    std::function<std::unique_ptr<OutputTarget>(const OutputPatience& patience)> open;
};

/// Registry entry of a kind of output. A backend is one file, outputs/NAME_output.cpp, with
/// `NAME_output_entry()`.
struct OutputEntry {
    std::string scheme;
    std::string words;  ///< form of its URL, for help
    /// Throws Error if the URL is not valid.
    std::function<OutputPlan(const OutputUrl& url, const OutputFormat& format)> plan;
};
std::vector<OutputEntry> output_entries();

/// Creates the plan by the scheme of the URL. Throws Error, also for an unknown scheme.
OutputPlan plan_output(const std::string& url, const OutputFormat& format);

}  // namespace vantage

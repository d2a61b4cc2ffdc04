#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/av/sound.h"
#include "common/base/error.h"
#include "common/image/image.h"
#include "host_app/output/output_retry.h"
#include "host_app/output/output_url.h"

namespace vantage {

class ScreenFeed;

/// The programme, as every output has it.
struct OutputFormat {
    int width_px = 1280, height_px = 720;
    double rate_hz = 30;              ///< 29.97 and its like are n * 1000 / 1001
    std::string encoder = "libx264";  ///< one of known_encoders()
    bool overwrites = false;          ///< a file that is there may be replaced
    bool has_sound = false;           ///< every tick has a SoundBlock
};

/// Whoever called a listening output has left: its end, and no failure.
class CallerLeft : public Error {
  public:
    using Error::Error;
};

/// Where an output's pictures go, open. Made, used and destroyed on the output's own thread, which
/// may wait; destroyed without finish() it leaves nothing half-way.
class OutputTarget {
  public:
    virtual ~OutputTarget() = default;
    /// The picture of tick n, the first of which is 0; ticks that were left out are missing.
    /// `timecode` is its, or empty. Throws Error if the target has failed.
    virtual void write(const ColourImage& picture, std::int64_t tick,
                       const std::string& timecode) = 0;
    /// The sound of tick n, where the plan says that the target takes sound: in the order of ticks,
    /// right after the picture; that of a tick whose picture was left out comes before the next.
    virtual void hear(const SoundBlock& /*sound*/, std::int64_t /*tick*/) {}
    /// Called where no picture waits: what carries no times makes up here for one tick that was
    /// left out. False: there is none. Throws as write().
    virtual bool catch_up() { return false; }
    /// Ends it well. Throws Error if it has failed.
    virtual void finish() {}
    /// After write() has failed: keeps what can be kept of what was written. What to add to the
    /// sentence of the failure.
    virtual std::string salvage() { return ""; }
    /// Written so far.
    virtual std::uint64_t bytes() const = 0;
};

/// How an output is made of its URL; all of it that can be known before it is opened is checked.
struct OutputPlan {
    std::string name;        ///< for people, without secrets
    std::string film = "";   ///< its file, where it is one
    bool begins = true;      ///< at once; else when somebody asks for it
    bool is_stream = false;  ///< what fails is tried again, and what nobody takes is no loss
    bool takes_sound = false;
    bool is_listening = false;  ///< opening it waits for somebody who calls
    bool is_encoded = true;
    bool takes_stdout = false;
    std::shared_ptr<ScreenFeed> screen = {};  ///< that somebody has to show; null: none
    /// Waits until it is open; gives up, and throws, soon after the patience is over, as write()
    /// does. Throws Error if it cannot be opened. May be called again after what it made is gone.
    std::function<std::unique_ptr<OutputTarget>(const OutputPatience& patience)> open;
};

/// A kind of output. A backend is a file outputs/NAME_output.cpp with `NAME_output_entry()`.
struct OutputEntry {
    std::string scheme;
    std::string words;  ///< how its URL is written, for people
    /// Throws Error for what cannot be.
    std::function<OutputPlan(const OutputUrl& url, const OutputFormat& format)> plan;
};
std::vector<OutputEntry> output_entries();

/// The plan of whichever kind the URL is of. Throws Error, also for a URL of no kind.
OutputPlan plan_output(const std::string& url, const OutputFormat& format);

}  // namespace vantage

#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time/time.h"
#include "host_app/output/output.h"

namespace vantage {

/// Owner of all outputs of a programme. Each starts, stops and fails independently, also while the
/// programme runs. Outputs get the clean picture, never the overlays for operators. Thread-safe.
class OutputSupervisor {
  public:
    struct Settings {
        OutputFormat format;  ///< the requested encoder; empty: the first one that works
        double pulse_rate_hz = 30;
        std::vector<std::string> urls;  ///< started at once, unless they contain start=off
    };
    /// Throws Error for an invalid URL. An output that cannot be opened fails later, without effect
    /// on the others.
    explicit OutputSupervisor(Settings settings);

    /// Checks the settings without opening anything. Throws Error like the constructor.
    static void check(const Settings& settings);

    /// Sink for the programme; this object must outlive it.
    std::unique_ptr<PictureSink> sink();

    /// Adds an output and starts it, unless its URL contains start=off. Returns its number, from 0.
    /// Throws Error for an invalid URL.
    std::size_t add(const std::string& url);
    /// Start and stop an output; they never wait. Precondition: an output has this number.
    void start(std::size_t number);
    void stop(std::size_t number);
    bool is_wanted(std::size_t number) const;
    /// Ends all outputs; waiting frames are written.
    void finish();

    std::vector<OutputState> states() const;
    /// Feeds of outputs to monitors, for the thread that owns the windows.
    std::vector<std::shared_ptr<ScreenFeed>> screens() const;
    /// Number of frames that the shared encoders of streams have encoded so far.
    std::uint64_t encoded() const { return settings_.format.encoders->encoded(); }
    /// True if an output writes to standard output.
    bool takes_stdout() const;

  private:
    class Fan;
    std::vector<std::shared_ptr<Output>> outputs() const;

    Settings settings_;
    std::mutex adding_;  ///< held while an encoder is tried; the programme never waits for it
    mutable std::mutex mutex_;
    bool has_encoder_ = false;  ///< the encoder was chosen
    bool takes_stdout_ = false;
    std::vector<std::shared_ptr<Output>> outputs_;
    std::vector<std::shared_ptr<ScreenFeed>> screens_;
};

/// The operator's keys for outputs: a press starts an output that is off, and a second press within
/// three seconds stops one that runs. Used on the session's thread.
class OutputSwitch {
  public:
    explicit OutputSwitch(OutputSupervisor& outputs) : outputs_(outputs) {}

    /// Takes a press for an output, from 1 on. If there is no such output, question() says so.
    void press(int number, MonotonicTime now);
    /// The question or the message for the operator; empty: none.
    std::string question(MonotonicTime now) const;

  private:
    struct Asked {
        int number;
        std::string words;
        MonotonicTime until;
    };
    OutputSupervisor& outputs_;
    std::optional<Asked> asked_;
};

}  // namespace vantage

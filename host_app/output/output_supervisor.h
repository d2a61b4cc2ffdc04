#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "host_app/output/output.h"

namespace vantage {

/// A programme's outputs, each of which is begun, ended and fails by itself, also while the
/// programme runs. They get the clean picture, never what is laid over it for people. Thread-safe.
class OutputSupervisor {
  public:
    struct Settings {
        OutputFormat format;  ///< the requested encoder; empty: the first one that works
        double pulse_rate_hz = 30;
        std::vector<std::string> urls;  ///< begun at once, unless they say start=off
    };
    /// Throws Error for a URL that cannot be; what only opening shows fails later, alone.
    explicit OutputSupervisor(Settings settings);

    /// Throws Error as the constructor would, and opens nothing.
    static void check(const Settings& settings);

    /// For the programme; this must outlive it.
    std::unique_ptr<PictureSink> sink();

    /// Another one, begun at once unless its URL says start=off; its number, from 0 on. Throws
    /// Error for what cannot be.
    std::size_t add(const std::string& url);
    /// Never wait. Precondition: the number is of one.
    void start(std::size_t number);
    void stop(std::size_t number);
    bool is_wanted(std::size_t number) const;
    /// Ends all of them; what waits is written.
    void finish();

    std::vector<OutputState> states() const;
    /// Those that are to be shown on monitors, by the thread that may have windows.
    std::vector<std::shared_ptr<ScreenFeed>> screens() const;
    /// The standard output is one of them.
    bool takes_stdout() const;

  private:
    class Fan;
    std::vector<std::shared_ptr<Output>> outputs() const;

    Settings settings_;
    std::mutex adding_;  ///< held while an encoder is tried; the programme never waits for it
    mutable std::mutex mutex_;
    bool has_encoder_ = false;  ///< it was chosen
    bool takes_stdout_ = false;
    std::vector<std::shared_ptr<Output>> outputs_;
    std::vector<std::shared_ptr<ScreenFeed>> screens_;
};

}  // namespace vantage

#pragma once

#include <filesystem>
#include <future>
#include <mutex>
#include <string>

#include "host_app/session/live_show.h"

namespace vantage {

/// Saves what a session has learnt of its set, on a thread of its own: neither programme nor
/// session waits for the file. One at a time.
class BackgroundSaver {
  public:
    /// With a `path` sets are saved there, the second as PATH-2; without one where the program was
    /// started, named for the time. The show must outlive it. Throws Error for a path that cannot
    /// be written.
    BackgroundSaver(LiveShow& show, std::filesystem::path path);

    /// Begins to save; what is wrong with that shows in the log and state.
    void save();
    /// Waits for what is being saved.
    void finish();

    struct State {
        std::string path;     ///< of the last that was saved; empty: none
        std::string failure;  ///< of the last; empty: none
    };
    State state() const;

  private:
    void write(std::future<Background> set, const std::filesystem::path& path);

    LiveShow& show_;
    std::filesystem::path path_;
    mutable std::mutex mutex_;
    State state_;
    std::future<void> work_;
};

}  // namespace vantage

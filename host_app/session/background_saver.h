#pragma once

#include <filesystem>
#include <future>
#include <mutex>
#include <string>

#include "host_app/session/live_show.h"

namespace vantage {

/// Saves the learnt background to a file on a thread of its own, one file at a time, so that
/// neither programme nor session waits. Used on the session's thread.
class BackgroundSaver {
  public:
    /// Saves to `path`, the second time to PATH-2, or without a path to the working folder under
    /// the name of the time. The show must outlive this object. Throws Error if the path exists or
    /// cannot be written.
    BackgroundSaver(LiveShow& show, std::filesystem::path path);

    /// Starts to save. Failures are logged and kept in state().
    void save();
    /// Waits until the file is written.
    void finish();

    struct State {
        std::string path;     ///< the last file that was saved; empty: none
        std::string failure;  ///< of the last attempt; empty: none
    };
    State state() const;

  private:
    void write(std::future<Background> background, const std::filesystem::path& path);

    LiveShow& show_;
    std::filesystem::path path_;
    mutable std::mutex mutex_;
    State state_;
    std::future<void> work_;
};

}  // namespace vantage

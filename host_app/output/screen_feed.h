#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "common/image/image.h"

namespace vantage {

/// Passes the newest picture from an output's thread to the thread that owns the windows.
/// Thread-safe.
class ScreenFeed {
  public:
    enum class State {
        closed,
        asked,  ///< a window is requested
        shown,
        failed,
    };
    /// Monitors count from 1.
    explicit ScreenFeed(int monitor) : monitor_(monitor) {}
    int monitor() const { return monitor_; }
    State state() const;

    // For the output's thread.
    void ask();
    /// Throws Error if the window is gone.
    void put(const ColourImage& picture);
    void close();
    std::string failure() const;

    // For the thread that owns the windows.
    void show();
    void fail(const std::string& why);
    /// Newest picture that was not taken yet; empty if there is none.
    ColourImage take();

  private:
    int monitor_;
    mutable std::mutex mutex_;
    State state_ = State::closed;
    std::string failure_;
    ColourImage picture_;
};

}  // namespace vantage

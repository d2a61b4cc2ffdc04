#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "common/image/image.h"

namespace vantage {

/// The newest picture for a monitor, on its way from an output's thread to the one thread that may
/// have windows. Thread-safe.
class ScreenFeed {
  public:
    enum class State {
        closed,
        asked,  ///< for a window
        shown,
        failed,
    };
    /// Monitors are counted from 1 on.
    explicit ScreenFeed(int monitor) : monitor_(monitor) {}
    int monitor() const { return monitor_; }
    State state() const;

    // Of the output.
    void ask();
    /// Throws Error if the window is not there any more.
    void put(const ColourImage& picture);
    void close();
    std::string failure() const;

    // Of whoever has the windows.
    void show();
    void fail(const std::string& why);
    /// What was not taken yet; empty: nothing.
    ColourImage take();

  private:
    int monitor_;
    mutable std::mutex mutex_;
    State state_ = State::closed;
    std::string failure_;
    ColourImage picture_;
};

}  // namespace vantage

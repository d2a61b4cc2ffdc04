#pragma once

namespace vantage {

/// Turns SIGHUP into a request to reload the configuration, as in a service. In a process with a
/// controlling terminal SIGHUP keeps its other meaning: the terminal was closed. Construct it
/// before any other thread starts, since threads inherit the blocked signal.
class ReloadSignal {
  public:
    ReloadSignal();
    ~ReloadSignal();
    ReloadSignal(const ReloadSignal&) = delete;
    ReloadSignal& operator=(const ReloadSignal&) = delete;

    /// Whether the signal has come since the last call. Never waits.
    bool take();

  private:
    int fd_ = -1;  ///< -1: SIGHUP is not taken
};

}  // namespace vantage

#pragma once

#include <chrono>

namespace vantage {

/// Turns SIGINT and SIGTERM into a state that a loop polls, so that a program ends in order: files
/// finished, sockets closed, the summary printed. Construct it before any other thread starts,
/// since threads inherit the blocked signals. A second signal ends the program at once, unless it
/// follows the first one within `same_request`: then it is the same request, sent twice.
class StopSignal {
  public:
    /// Throws Error if the system refuses a signal descriptor.
    StopSignal();
    ~StopSignal();
    StopSignal(const StopSignal&) = delete;
    StopSignal& operator=(const StopSignal&) = delete;

    /// A second signal within this time is the same request.
    static constexpr std::chrono::milliseconds same_request{500};
    /// How often a loop that waits for other events should poll for a stop signal.
    static constexpr std::chrono::milliseconds look_period{50};

    bool requested() { return wait_for(std::chrono::nanoseconds(0)); }
    /// Sleeps for `time`. Returns true at once when a stop signal arrives.
    bool wait_for(std::chrono::nanoseconds time);

    /// Whether the latest StopSignal of this process received SIGINT (Ctrl-C). The exit status
    /// depends on it.
    static bool was_interrupted();

  private:
    int fd_;
    bool requested_ = false;
};

}  // namespace vantage

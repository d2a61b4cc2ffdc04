#pragma once

#include <chrono>

namespace vantage {

/// Turns SIGINT and SIGTERM into a question that a loop asks, so that a program ends in order:
/// files finished, sockets closed, the summary printed. To be made before any other thread is
/// started, since threads inherit the blocked signals. A second signal ends the program at once, unless
/// it follows the first one within `same_request`: then it is the same request, sent twice.
class StopSignal {
  public:
    /// Throws Error if the system gives no descriptor for it.
    StopSignal();
    ~StopSignal();
    StopSignal(const StopSignal&) = delete;
    StopSignal& operator=(const StopSignal&) = delete;

    /// A second signal that comes so soon is the same request.
    static constexpr std::chrono::milliseconds same_request{500};
    /// So often looks who waits for something else meanwhile.
    static constexpr std::chrono::milliseconds look_period{50};

    bool requested() { return wait_for(std::chrono::nanoseconds(0)); }
    /// Sleeps; returns at once, and true, when the program is asked to stop.
    bool wait_for(std::chrono::nanoseconds time);

    /// Ctrl-C (SIGINT) has been taken, by the latest of these objects: a fact about the process, by
    /// which its exit status goes.
    static bool was_interrupted();

  private:
    int fd_;
    bool requested_ = false;
};

}  // namespace vantage

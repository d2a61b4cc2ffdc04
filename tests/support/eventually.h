#pragma once

#include <chrono>
#include <thread>

namespace vantage {

#ifdef __SANITIZE_THREAD__
/// Shaders compile ten times as slowly with this sanitizer.
constexpr std::chrono::minutes longest_wait{10};
#else
constexpr std::chrono::minutes longest_wait{2};
#endif

/// Waits until the condition is true, and returns whether that happened within `limit`, which is
/// far beyond the duration of any test. Checks the condition once per `period`. All tests wait for
/// events with this function.
template <class Condition>
bool eventually(Condition condition, std::chrono::nanoseconds limit = longest_wait,
                std::chrono::nanoseconds period = std::chrono::milliseconds(5)) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (std::chrono::steady_clock::now() < end) {
        if (condition()) return true;
        std::this_thread::sleep_for(period);
    }
    return false;
}

}  // namespace vantage

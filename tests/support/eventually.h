#pragma once

#include <chrono>
#include <thread>

namespace vantage {

#ifdef __SANITIZE_THREAD__
/// Shaders take ten times as long to compile, and virtual machines run beside these tests.
constexpr std::chrono::minutes longest_wait{10};
#else
constexpr std::chrono::minutes longest_wait{2};
#endif

/// Whether the condition holds within the longest wait: far beyond what any test waits for, so that
/// one that waits so long has failed. It is asked every five milliseconds.
template <class Condition>
bool eventually(Condition condition) {
    const auto end = std::chrono::steady_clock::now() + longest_wait;
    while (std::chrono::steady_clock::now() < end) {
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
}

}  // namespace vantage

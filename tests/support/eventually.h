#pragma once

#include <chrono>
#include <thread>

namespace vantage {

/// Whether the condition holds within a minute: far beyond what any test waits for, so that one
/// that waits so long has failed. It is asked every two milliseconds.
template <class Condition>
bool eventually(Condition condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < end) {
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
}

}  // namespace vantage

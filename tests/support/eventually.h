#pragma once

#include <chrono>
#include <thread>

namespace vantage {

/// Whether the condition holds within two minutes: far beyond what any test waits for, so that one
/// that waits so long has failed. It is asked every five milliseconds.
template <class Condition>
bool eventually(Condition condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (std::chrono::steady_clock::now() < end) {
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
}

}  // namespace vantage

#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace vantage {

/// Far beyond what any fault takes; a test that waits so long has failed.
inline constexpr std::chrono::seconds patience{60};

/// Whether it does within that time.
inline bool comes_true(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (std::chrono::steady_clock::now() < end) {
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
}

}  // namespace vantage

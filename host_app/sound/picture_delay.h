#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdlib>

namespace vantage {

/// Estimates the pictures' delay, for sound that is output with them: the median of the latest
/// delays, updated only when it has moved noticeably. Not thread-safe.
class PictureDelay {
  public:
    void see(std::chrono::nanoseconds latency) {
        latest_[seen_++ % latest_.size()] = latency;
        const auto end =
            latest_.begin() + static_cast<std::ptrdiff_t>(std::min(seen_, latest_.size()));
        std::array<std::chrono::nanoseconds, most> sorted = latest_;
        const auto sorted_end = sorted.begin() + (end - latest_.begin());
        const auto middle = sorted.begin() + (sorted_end - sorted.begin()) / 2;
        std::nth_element(sorted.begin(), middle, sorted_end);
        // A third of a picture at 30 Hz.
        // A third of a picture at 30 Hz.
        if (seen_ == 1 || std::chrono::abs(*middle - now_) > unseen) now_ = *middle;
    }
    std::chrono::nanoseconds now() const { return now_; }
    std::size_t seen() const { return seen_; }

  private:
    /// Enough for some seconds.
    static constexpr std::size_t most = 127;
    std::array<std::chrono::nanoseconds, most> latest_{};
    std::size_t seen_ = 0;
    std::chrono::nanoseconds now_{0};
};

}  // namespace vantage

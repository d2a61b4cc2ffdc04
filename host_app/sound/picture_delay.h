#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdlib>

namespace vantage {

/// How long pictures are on their way, for sound that is to leave with them: the middle one of the
/// latest, which changes only where it has moved by more than anybody sees.
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
        constexpr std::chrono::milliseconds unseen{10};
        if (seen_ == 1 || std::chrono::abs(*middle - now_) > unseen) now_ = *middle;
    }
    std::chrono::nanoseconds now() const { return now_; }
    std::size_t seen() const { return seen_; }

  private:
    /// Some seconds of instants.
    static constexpr std::size_t most = 127;
    std::array<std::chrono::nanoseconds, most> latest_{};
    std::size_t seen_ = 0;
    std::chrono::nanoseconds now_{0};
};

}  // namespace vantage

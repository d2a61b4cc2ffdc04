#pragma once

#include <array>
#include <atomic>

namespace vantage {

/// Hands the latest value from one thread to another without a lock, so that neither ever waits for
/// the other, not even where one has real-time priority and the other was preempted. A value that
/// was not taken is replaced by the next (triple buffer). One thread gives, one thread takes.
template <class T>
class LatestValue {
  public:
    void give(const T& value) {
        slots_[given_] = value;
        given_ = shared_.exchange(given_ | fresh, std::memory_order_acq_rel) & ~fresh;
    }
    /// Returns the latest value, or null if nothing was given since the last call. It stays valid
    /// until the next call.
    const T* take() {
        if ((shared_.load(std::memory_order_relaxed) & fresh) == 0) return nullptr;
        taken_ = shared_.exchange(taken_, std::memory_order_acq_rel) & ~fresh;
        return &slots_[taken_];
    }

  private:
    static constexpr unsigned fresh = 4;  ///< marks a shared slot that was not taken

    std::array<T, 3> slots_{};
    unsigned given_ = 0;               ///< slot of the giving thread
    unsigned taken_ = 1;               ///< slot of the taking thread
    std::atomic<unsigned> shared_{2};  ///< the third slot
};

}  // namespace vantage

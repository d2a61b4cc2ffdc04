#pragma once

#include <chrono>

#include <GLES3/gl31.h>

namespace vantage {

/// A point in the command stream of a context, for which threads and contexts of its sharing group
/// can wait. Move-only; may be used and destroyed under any context of the group. A
/// default-constructed fence counts as reached.
class Fence {
  public:
    Fence() = default;
    /// Inserts a fence after the commands issued so far, and flushes them.
    static Fence insert();
    Fence(Fence&& other) noexcept;
    Fence& operator=(Fence&& other) noexcept;
    ~Fence();

    /// Whether the GPU has reached the point; never waits. Throws Error if the GPU is lost.
    bool reached() const { return reached_within(std::chrono::nanoseconds(0)); }
    /// Waits up to `time` for the GPU; returns whether it reached the point. Throws Error if the
    /// GPU is lost.
    bool reached_within(std::chrono::nanoseconds time) const;
    /// A GPU that works on something for longer than this hangs.
    static constexpr std::chrono::seconds hung_after{10};
    /// No limit for wait() but hung_after, and none at all for a software renderer, which is slow
    /// and never hangs.
    static constexpr std::chrono::nanoseconds no_limit = std::chrono::nanoseconds::max();

    /// Waits for the GPU. Throws ContextLost with `doing` if the GPU was reset or has not reached
    /// the point within `limit` (it hangs, or the driver cannot report resets), Error if it is
    /// lost.
    void wait(const char* doing, std::chrono::nanoseconds limit = no_limit) const;
    /// Makes later commands of the current context wait for the point; the thread does not wait.
    void hold_current_context() const;

  private:
    GLsync sync_ = nullptr;
};

}  // namespace vantage

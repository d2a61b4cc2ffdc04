#pragma once

#include <chrono>

#include <GLES3/gl31.h>

namespace vantage {

/// A point in a context's commands that other threads, and contexts that share with it, can wait
/// for. Move-only; may be used and destroyed under any context of the sharing group. Without a
/// point (the default) it counts as reached.
class Fence {
  public:
    Fence() = default;
    /// The point after what the current context was given so far, which is sent on its way.
    static Fence insert();
    Fence(Fence&& other) noexcept;
    Fence& operator=(Fence&& other) noexcept;
    ~Fence();

    /// Whether the GPU got there; never waits. Throws Error if the GPU is lost.
    bool reached() const { return reached_within(std::chrono::nanoseconds(0)); }
    /// This thread waits until the GPU gets there, or for `time`; whether it did. Throws Error if
    /// the GPU is lost.
    bool reached_within(std::chrono::nanoseconds time) const;
    /// No limit for wait().
    static constexpr std::chrono::nanoseconds no_limit = std::chrono::nanoseconds::max();

    /// This thread waits until the GPU gets there. Throws ContextLost with `doing` if it was reset
    /// or has not got there within `limit` (it hangs, or a driver that cannot tell of resets has
    /// reset it), Error if it is lost.
    void wait(const char* doing, std::chrono::nanoseconds limit = no_limit) const;
    /// The current context's later commands wait for the point; this thread does not.
    void hold_current_context() const;

  private:
    GLsync sync_ = nullptr;
};

}  // namespace vantage

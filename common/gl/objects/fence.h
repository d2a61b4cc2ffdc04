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
    /// This thread waits until the GPU gets there, however long that takes. Throws ContextLost with
    /// `doing` if it was reset, Error if it is lost.
    void wait(const char* doing) const;
    /// The current context's later commands wait for the point; this thread does not.
    void hold_current_context() const;

  private:
    GLsync sync_ = nullptr;
};

}  // namespace vantage

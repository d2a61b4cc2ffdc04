#pragma once

#include <memory>
#include <mutex>

#include <EGL/egl.h>

namespace vantage {

/// Shared ownership of an EGL display connection. EGL has one connection per native display and
/// process, and the first eglTerminate() ends it with all its contexts. Here the end of the last
/// owner does. Thread-safe.
class EglDisplayHold {
  public:
    EglDisplayHold() = default;
    /// Initialises the display if no other hold has. Keeps `native` (the object that the display
    /// was made from, if any) until the display ends. If EGL refuses, held() is false and
    /// eglGetError() has the reason.
    static EglDisplayHold open(EGLDisplay display, std::shared_ptr<void> native);
    /// Joins the existing holds on `display`. Precondition: there is one, such as that of the
    /// context that a new context shares with.
    static EglDisplayHold join(EGLDisplay display);

    EglDisplayHold(EglDisplayHold&& other) noexcept;
    EglDisplayHold& operator=(EglDisplayHold&& other) noexcept;
    ~EglDisplayHold();

    bool held() const { return display_ != EGL_NO_DISPLAY; }
    /// One mutex per display, for threads that call its driver (DriverLock). Null if not held.
    std::mutex* driver() const { return driver_; }

  private:
    EglDisplayHold(EGLDisplay display, std::mutex& driver) : display_(display), driver_(&driver) {}
    EGLDisplay display_ = EGL_NO_DISPLAY;
    std::mutex* driver_ = nullptr;
};

}  // namespace vantage

#pragma once

#include <memory>
#include <mutex>

#include <EGL/egl.h>

namespace vantage {

/// One holder's part of a display connection. EGL has one connection a native display for the whole
/// process and ends it, with all its contexts, at the first eglTerminate: here the last holder's
/// end does that. May be made and destroyed on any thread.
class EglDisplayHold {
  public:
    EglDisplayHold() = default;
    /// Initialises the display unless another hold did, and keeps `native` (what the display was
    /// made from, where that is an object) until the display ends. `held()` is false, and
    /// eglGetError() says why, where EGL refuses.
    static EglDisplayHold open(EGLDisplay display, std::shared_ptr<void> native);
    /// Joins the holds on `display`. Precondition: there is one, as that of a context which the new
    /// one is to share with.
    static EglDisplayHold join(EGLDisplay display);

    EglDisplayHold(EglDisplayHold&& other) noexcept;
    EglDisplayHold& operator=(EglDisplayHold&& other) noexcept;
    ~EglDisplayHold();

    bool held() const { return display_ != EGL_NO_DISPLAY; }
    /// One for all who hold the display: what threads that draw there may take turns for
    /// (DriverTurn). Null if it is not held.
    std::mutex* driver() const { return driver_; }

  private:
    EglDisplayHold(EGLDisplay display, std::mutex& driver) : display_(display), driver_(&driver) {}
    EGLDisplay display_ = EGL_NO_DISPLAY;
    std::mutex* driver_ = nullptr;
};

}  // namespace vantage

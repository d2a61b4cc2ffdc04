#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <EGL/egl.h>

#include "common/gl/context/egl_display.h"

namespace vantage {

/// The name of this thread's last EGL error, which it clears; or the name of this code.
std::string egl_error_name();
std::string egl_error_name(EGLint code);

/// One attempt to reach a GPU without a display, and its result.
struct EglAttempt {
    std::string platform;  ///< "surfaceless", "device 0", "gbm /dev/dri/renderD128"
    std::string outcome;   ///< "ok" for the one in use, otherwise the reason it failed
};

/// Whether contexts of this display report GPU resets (see context_loss.h).
bool makes_robust_contexts(EGLDisplay display);

/// An OpenGL ES 3.1 context without a window. It may be destroyed on any thread once it is current
/// on none.
class EglContext {
  public:
    /// Creates a context and makes it current on this thread. Tries the surfaceless platform, EGL
    /// devices and GBM render nodes, in this order. Takes software rendering only if no EGL device
    /// is a working GPU. If all attempts fail, throws Error that lists each with its reason.
    EglContext();
    /// Creates a context that shares textures, buffers, programs and fences with another one, which
    /// need not be current; framebuffers and vertex arrays are not shared. The new context is not
    /// made current; use CurrentContext. Throws Error if the driver refuses.
    static EglContext sharing_with(const EglContext& other);
    ~EglContext();
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;

    /// The attempts of the first constructor; empty for a sharing context.
    const std::vector<EglAttempt>& attempts() const { return attempts_; }
    EGLDisplay display() const { return display_; }
    /// The mutex that the threads of this display lock while they call the driver (DriverLock);
    /// null if the driver needs none.
    std::mutex* driver() const { return needs_turns_ ? hold_.driver() : nullptr; }
    bool has_extension(const char* egl_extension) const;

  private:
    friend class CurrentContext;
    EglContext(EGLDisplay display, EGLContext shared, bool needs_turns);
    bool try_platform(EGLenum platform, void* native_display, const std::string& name,
                      std::shared_ptr<void> native_owner = {});
    void try_devices();
    void try_gbm();
    bool ready() const { return context_ != EGL_NO_CONTEXT; }
    bool has_gpu() const { return ready() && !is_software_; }

    std::vector<EglAttempt> attempts_;
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EglDisplayHold hold_;
    EGLContext context_ = EGL_NO_CONTEXT;
    bool is_software_ = false, needs_turns_ = false;
};

/// Makes a context current on this thread during its life, and restores the previous one after it.
class CurrentContext {
  public:
    struct None {};
    /// Makes no context current, so that GL calls do nothing. For destroying objects of lost
    /// contexts, whose names belong to other objects by now.
    explicit CurrentContext(None);
    /// Whether that was done on this thread.
    static bool is_none();
    /// Throws Error if the context cannot be made current, such as when it is current on another
    /// thread; ContextLost if the GPU was reset.
    explicit CurrentContext(const EglContext& context);
    ~CurrentContext();
    CurrentContext(const CurrentContext&) = delete;
    CurrentContext& operator=(const CurrentContext&) = delete;

  private:
    CurrentContext();

    EGLDisplay display_;  ///< of the previous context
    EGLDisplay previous_display_;
    EGLSurface previous_draw_, previous_read_;
    EGLContext previous_;
    bool was_none_;
};

}  // namespace vantage

#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <EGL/egl.h>

#include "common/gl/context/egl_display.h"

namespace vantage {

/// The name of the last EGL error of this thread, and takes it back; or of this one.
std::string egl_error_name();
std::string egl_error_name(EGLint code);

/// One way that was tried to reach a GPU without a display, and how it went.
struct EglAttempt {
    std::string platform;  ///< "surfaceless", "device 0", "gbm /dev/dri/renderD128"
    std::string outcome;   ///< "ok" of the one that is used, or why not
};

/// Whether contexts of this display tell that the GPU was reset (see context_loss.h).
bool makes_robust_contexts(EGLDisplay display);

/// An OpenGL ES 3.1 context without a window. A thread uses it while it is current there; it may be
/// destroyed on another thread once it is current on none.
class EglContext {
  public:
    /// Current on the constructing thread. Tried in this order: the surfaceless platform, EGL
    /// devices, GBM render nodes; one that the processor draws is taken where no EGL device is a
    /// GPU that works. Throws Error that lists every attempt and its reason, if none works.
    EglContext();
    /// One that shares textures, buffers, programs and fences with another, whether that is current
    /// anywhere or not; framebuffers and vertex arrays stay each context's own. Nothing becomes
    /// current: a thread takes it with CurrentContext. Throws Error if the driver refuses.
    static EglContext sharing_with(const EglContext& other);
    ~EglContext();
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;

    /// Of the search that the first constructor makes; empty for a sharing one.
    const std::vector<EglAttempt>& attempts() const { return attempts_; }
    EGLDisplay display() const { return display_; }
    /// What all threads that draw on this display take turns for (DriverTurn); null where they need
    /// not.
    std::mutex* driver() const { return is_software_ ? hold_.driver() : nullptr; }
    bool has_extension(const char* egl_extension) const;

  private:
    friend class CurrentContext;
    EglContext(EGLDisplay display, EGLContext shared, bool is_software);
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
    bool is_software_ = false;
};

/// Makes a context current on this thread for its own life, and what was current before after it.
class CurrentContext {
  public:
    struct None {};
    /// None is current: what GL is asked does nothing. For the objects of lost contexts, whose
    /// names mean others by now.
    explicit CurrentContext(None);
    /// Throws Error if it cannot be made current: it is so on another thread; ContextLost if the
    /// GPU was reset.
    explicit CurrentContext(const EglContext& context);
    ~CurrentContext();
    CurrentContext(const CurrentContext&) = delete;
    CurrentContext& operator=(const CurrentContext&) = delete;

  private:
    CurrentContext();

    EGLDisplay display_;  ///< of the context
    EGLDisplay previous_display_;
    EGLSurface previous_draw_, previous_read_;
    EGLContext previous_;
};

}  // namespace vantage

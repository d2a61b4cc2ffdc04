#pragma once

#include <string>
#include <vector>

#include <EGL/egl.h>

namespace vantage {

/// The name of the last EGL error of this thread, and takes it back.
std::string egl_error_name();

/// One way that was tried to reach a GPU without a display, and how it went.
struct EglAttempt {
    std::string platform;  ///< "surfaceless", "device 0", "gbm /dev/dri/renderD128"
    std::string outcome;   ///< "ok", or the reason why not
};

/// A headless OpenGL ES 3.1 context that owns its display connection. Tried in this order: the
/// surfaceless platform, EGL devices, GBM render nodes. The context is current on the constructing
/// thread and must be used and destroyed there.
class EglContext {
  public:
    /// Throws Error that lists every attempt and its reason, if none works.
    EglContext();
    ~EglContext();
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;

    const std::vector<EglAttempt>& attempts() const { return attempts_; }
    EGLDisplay display() const { return display_; }
    bool has_extension(const char* egl_extension) const;

  private:
    bool try_platform(EGLenum platform, void* native_display, const std::string& name);
    void try_devices();
    void try_gbm();
    bool ready() const { return context_ != EGL_NO_CONTEXT; }

    std::vector<EglAttempt> attempts_;
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
    int gbm_fd_ = -1;
    void* gbm_device_ = nullptr;
};

}  // namespace vantage

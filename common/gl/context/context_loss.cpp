#include "common/gl/context/context_loss.h"

#include <EGL/egl.h>
#include <GLES3/gl31.h>

#include "common/gl/context/egl_context.h"

namespace vantage {

void require_context(const char* doing) {
    // A lost context answers no other query; the display knows whether it supports this one.
    if (!makes_robust_contexts(eglGetCurrentDisplay())) return;
    const auto reset_status =
        reinterpret_cast<GLenum (*)()>(eglGetProcAddress("glGetGraphicsResetStatusKHR"));
    if (reset_status && reset_status() != GL_NO_ERROR)
        throw ContextLost(
            fmt::format("the GPU was reset while {}: what its contexts held is lost", doing));
}

}  // namespace vantage

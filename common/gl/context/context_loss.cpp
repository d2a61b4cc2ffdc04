#include "common/gl/context/context_loss.h"

#include <EGL/egl.h>
#include <GLES3/gl31.h>

#include "common/gl/context/egl_context.h"

namespace vantage {

void require_context(const char* doing) {
    // Of a lost context nothing can be asked but this; its display knows whether it can be.
    if (!makes_robust_contexts(eglGetCurrentDisplay())) return;
    const auto reset_status =
        reinterpret_cast<GLenum (*)()>(eglGetProcAddress("glGetGraphicsResetStatusKHR"));
    if (reset_status && reset_status() != GL_NO_ERROR)
        throw ContextLost(
            fmt::format("the GPU was reset while {}: what its contexts held is lost", doing));
}

}  // namespace vantage

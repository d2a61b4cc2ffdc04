#include "common/gl/objects/gl_handle.h"

#include <atomic>

#include "common/base/log.h"
#include "common/base/this_thread.h"
#include "common/gl/context/egl_context.h"

namespace vantage {

void expect_current_context() {
    // Windows have contexts of GLX, which EGL does not know.
    if (glGetString(GL_VERSION) || CurrentContext::is_none()) return;
    static std::atomic<bool> is_said = false;
    if (!is_said.exchange(true))
        log_warning(
            "a GPU object ended on the thread {}, which has no GPU context: its memory stays in "
            "use. Please report this",
            this_thread_name());
}

}  // namespace vantage

#include <algorithm>
#include <vector>

#include <GLES3/gl31.h>
// The extension header needs the core one before it.
#include <EGL/egl.h>
#include <GLES2/gl2ext.h>

#include "common/gl/context/limits.h"
#include "common/gl/objects/gpu_timer.h"

namespace vantage {
namespace {

template <class Function>
Function load(const char* name) {
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}

}  // namespace

void delete_timer_query(GLuint name) { glDeleteQueries(1, &name); }

// Mesa's software renderers list the extension, but their queries time the recording of commands:
// a few microseconds for any compute work, and garbage for the first span.
GpuTimer::GpuTimer()
    : uses_queries_(has_gl_extension("GL_EXT_disjoint_timer_query") &&
                    !GlInfo::query().is_software) {
    if (!uses_queries_) return;
    GLuint name = 0;
    glGenQueries(1, &name);
    query_ = GlHandle<delete_timer_query>(name);
}

void GpuTimer::begin() {
    if (uses_queries_) {
        glBeginQuery(GL_TIME_ELAPSED_EXT, query_.name());
    } else {
        glFinish();
        begin_time_ = std::chrono::steady_clock::now();
    }
}

void GpuTimer::end() {
    if (uses_queries_) {
        glEndQuery(GL_TIME_ELAPSED_EXT);
    } else {
        glFinish();
        last_ms_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() -
                                                             begin_time_)
                       .count();
    }
    pending_ = true;
}

double GpuTimer::wait_ms() {
    if (pending_ && uses_queries_) {
        static const auto get_result =
            load<PFNGLGETQUERYOBJECTUI64VEXTPROC>("glGetQueryObjectui64vEXT");
        GLuint64 ns = 0;
        get_result(query_.name(), GL_QUERY_RESULT, &ns);
        // The GPU's clock frequency changed during the span, so the count is no time.
        GLint is_disjoint = GL_FALSE;
        glGetIntegerv(GL_GPU_DISJOINT_EXT, &is_disjoint);
        if (!is_disjoint) last_ms_ = static_cast<double>(ns) * 1e-6;
    }
    pending_ = false;
    return last_ms_;
}

std::optional<double> GpuTimer::poll_ms() {
    if (!pending_) return std::nullopt;
    if (uses_queries_) {
        GLuint available = 0;
        glGetQueryObjectuiv(query_.name(), GL_QUERY_RESULT_AVAILABLE, &available);
        if (!available) return std::nullopt;
    }
    return wait_ms();
}

double median_gpu_ms(int repeats, const std::function<void()>& work) {
    GpuTimer timer;
    std::vector<double> times_ms;
    for (int i = 0; i < repeats; ++i) {
        timer.begin();
        work();
        timer.end();
        times_ms.push_back(timer.wait_ms());
    }
    const auto middle = times_ms.begin() + static_cast<std::ptrdiff_t>(times_ms.size() / 2);
    std::ranges::nth_element(times_ms, middle);
    return *middle;
}

}  // namespace vantage

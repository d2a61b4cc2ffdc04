#include "tests/support/gpu_reset.h"

#include <atomic>
#include <cstdint>
#include <cstring>
#include <map>
#include <mutex>

#include <EGL/egl.h>
#include <GLES3/gl31.h>
#include <dlfcn.h>

// After the version that it extends.
#include <GLES2/gl2ext.h>

// Interposes on the drivers' libraries: linked into a test that uses reset_gpu(), or preloaded.

namespace vantage {
namespace {

std::atomic<std::uint64_t> contexts_made = 0, contexts_lost = 0, contexts_hung = 0;

/// In the order of creation, from 1.
struct Contexts {
    std::mutex mutex;
    std::map<EGLContext, std::uint64_t> numbers;
};

Contexts& contexts() {
    static Contexts all;
    return all;
}

/// Whether the current context is one of the first `count`.
bool is_one_of(std::uint64_t count) {
    if (count == 0) return false;
    const std::lock_guard lock(contexts().mutex);
    const auto found = contexts().numbers.find(eglGetCurrentContext());
    return found != contexts().numbers.end() && found->second <= count;
}

bool is_lost() { return is_one_of(contexts_lost); }
bool hangs() { return is_one_of(contexts_hung); }

GLenum reset_status() { return is_lost() ? GL_UNKNOWN_CONTEXT_RESET_KHR : GL_NO_ERROR; }

template <class Function>
Function* real(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

void reset_gpu() { contexts_lost = contexts_made.load(); }

void hang_gpu() { contexts_hung = contexts_made.load(); }

}  // namespace vantage

extern "C" {

__eglMustCastToProperFunctionPointerType eglGetProcAddress(const char* name) {
    if (std::strcmp(name, "glGetGraphicsResetStatusKHR") == 0)
        return reinterpret_cast<__eglMustCastToProperFunctionPointerType>(vantage::reset_status);
    static const auto get = vantage::real<decltype(eglGetProcAddress)>("eglGetProcAddress");
    return get(name);
}

EGLContext eglCreateContext(EGLDisplay display, EGLConfig config, EGLContext shared,
                            const EGLint* wanted) {
    static const auto create = vantage::real<decltype(eglCreateContext)>("eglCreateContext");
    EGLContext made = create(display, config, shared, wanted);
    const std::lock_guard lock(vantage::contexts().mutex);
    if (made != EGL_NO_CONTEXT) vantage::contexts().numbers[made] = ++vantage::contexts_made;
    return made;
}

EGLBoolean eglDestroyContext(EGLDisplay display, EGLContext context) {
    static const auto destroy = vantage::real<decltype(eglDestroyContext)>("eglDestroyContext");
    {
        const std::lock_guard lock(vantage::contexts().mutex);
        vantage::contexts().numbers.erase(context);
    }
    return destroy(display, context);
}

GLenum glClientWaitSync(GLsync sync, GLbitfield flags, GLuint64 timeout) {
    static const auto wait = vantage::real<decltype(glClientWaitSync)>("glClientWaitSync");
    return vantage::hangs() ? GL_TIMEOUT_EXPIRED : wait(sync, flags, timeout);
}

const GLubyte* glGetString(GLenum name) {
    static const auto get = vantage::real<decltype(glGetString)>("glGetString");
    if (name == GL_RENDERER && vantage::hangs())
        return reinterpret_cast<const GLubyte*>("a GPU that hangs");
    return get(name);
}

void glDrawArrays(GLenum mode, GLint first, GLsizei count) {
    static const auto draw = vantage::real<decltype(glDrawArrays)>("glDrawArrays");
    if (!vantage::is_lost()) draw(mode, first, count);
}

void glDrawElements(GLenum mode, GLsizei count, GLenum type, const void* indices) {
    static const auto draw = vantage::real<decltype(glDrawElements)>("glDrawElements");
    if (!vantage::is_lost()) draw(mode, count, type, indices);
}

void glDrawElementsIndirect(GLenum mode, GLenum type, const void* command) {
    static const auto draw =
        vantage::real<decltype(glDrawElementsIndirect)>("glDrawElementsIndirect");
    if (!vantage::is_lost()) draw(mode, type, command);
}

void glDispatchCompute(GLuint x, GLuint y, GLuint z) {
    static const auto dispatch = vantage::real<decltype(glDispatchCompute)>("glDispatchCompute");
    if (!vantage::is_lost()) dispatch(x, y, z);
}

}  // extern "C"

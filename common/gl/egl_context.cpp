#include "common/gl/egl_context.h"

#include <array>
#include <cstring>
#include <filesystem>

#include <EGL/eglext.h>
#include <fcntl.h>
#include <gbm.h>
#include <unistd.h>

#include "common/base/error.h"

namespace vantage {
namespace {

bool lists_extension(const char* extensions, const char* wanted) {
    if (!extensions) return false;
    const std::size_t length = std::strlen(wanted);
    for (const char* at = extensions; (at = std::strstr(at, wanted)); at += length) {
        const bool starts = at == extensions || at[-1] == ' ';
        const bool ends = at[length] == ' ' || at[length] == '\0';
        if (starts && ends) return true;
    }
    return false;
}

}  // namespace

std::string egl_error_name() {
    switch (const EGLint code = eglGetError()) {
        case EGL_SUCCESS:
            return "no error given";
        case EGL_NOT_INITIALIZED:
            return "EGL_NOT_INITIALIZED";
        case EGL_BAD_ALLOC:
            return "EGL_BAD_ALLOC";
        case EGL_BAD_CONFIG:
            return "EGL_BAD_CONFIG";
        case EGL_BAD_MATCH:
            return "EGL_BAD_MATCH";
        case EGL_BAD_PARAMETER:
            return "EGL_BAD_PARAMETER";
        case EGL_BAD_DISPLAY:
            return "EGL_BAD_DISPLAY";
        case EGL_BAD_ATTRIBUTE:
            return "EGL_BAD_ATTRIBUTE";
        default:
            return fmt::format("EGL error 0x{:x}", code);
    }
}

EglContext::EglContext() {
    try_platform(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, "surfaceless");
    if (!ready()) try_devices();
    if (!ready()) try_gbm();
    if (ready()) return;
    std::string tried;
    for (const EglAttempt& attempt : attempts_)
        tried += fmt::format("; {}: {}", attempt.platform, attempt.outcome);
    fail(
        "no OpenGL ES 3.1 without a display on this computer (install Mesa's libgl1-mesa-dri, or a "
        "GPU driver){}",
        tried);
}

EglContext::~EglContext() {
    if (display_ != EGL_NO_DISPLAY) {
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
        eglTerminate(display_);
    }
    if (gbm_device_) gbm_device_destroy(static_cast<gbm_device*>(gbm_device_));
    if (gbm_fd_ >= 0) ::close(gbm_fd_);
}

bool EglContext::has_extension(const char* egl_extension) const {
    return lists_extension(eglQueryString(display_, EGL_EXTENSIONS), egl_extension);
}

bool EglContext::try_platform(EGLenum platform, void* native_display, const std::string& name) {
    const auto report = [&](std::string outcome) {
        attempts_.push_back({name, std::move(outcome)});
        return false;
    };
    const auto get_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
        eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (!get_display) return report("eglGetPlatformDisplayEXT is missing");
    EGLDisplay display = get_display(platform, native_display, nullptr);
    if (display == EGL_NO_DISPLAY) return report("no such platform (" + egl_error_name() + ")");
    EGLint major = 0, minor = 0;
    if (!eglInitialize(display, &major, &minor))
        return report("eglInitialize failed (" + egl_error_name() + ")");
    const auto give_up = [&](std::string outcome) {
        eglTerminate(display);
        return report(std::move(outcome));
    };
    if (!lists_extension(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context"))
        return give_up("EGL_KHR_surfaceless_context is missing");
    if (!eglBindAPI(EGL_OPENGL_ES_API)) return give_up("no OpenGL ES (" + egl_error_name() + ")");
    constexpr std::array<EGLint, 5> config_wanted = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT,
                                                     EGL_SURFACE_TYPE, 0, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display, config_wanted.data(), &config, 1, &count) || count < 1)
        return give_up("no configuration with OpenGL ES 3 (" + egl_error_name() + ")");
    constexpr std::array<EGLint, 5> context_wanted = {EGL_CONTEXT_MAJOR_VERSION, 3,
                                                      EGL_CONTEXT_MINOR_VERSION, 1, EGL_NONE};
    EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, context_wanted.data());
    if (context == EGL_NO_CONTEXT)
        return give_up("no OpenGL ES 3.1 context (" + egl_error_name() + ")");
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
        const std::string reason = egl_error_name();
        eglDestroyContext(display, context);
        return give_up("the context cannot be made current (" + reason + ")");
    }
    display_ = display;
    context_ = context;
    attempts_.push_back({name, "ok"});
    return true;
}

void EglContext::try_devices() {
    const auto query =
        reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
    std::array<EGLDeviceEXT, 8> devices{};
    EGLint count = 0;
    if (!query || !query(static_cast<EGLint>(devices.size()), devices.data(), &count) ||
        count < 1) {
        attempts_.push_back({"device", "EGL lists no devices"});
        return;
    }
    for (EGLint i = 0; i < count && !ready(); ++i)
        try_platform(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)],
                     fmt::format("device {}", i));
}

void EglContext::try_gbm() {
    bool any = false;
    for (int minor = 128; minor < 136 && !ready(); ++minor) {
        const std::string node = fmt::format("/dev/dri/renderD{}", minor);
        if (!std::filesystem::exists(node)) continue;
        any = true;
        const int fd = ::open(node.c_str(), O_RDWR | O_CLOEXEC);
        if (fd < 0) {
            attempts_.push_back({"gbm " + node, std::strerror(errno)});
            continue;
        }
        gbm_device* device = gbm_create_device(fd);
        if (device && try_platform(EGL_PLATFORM_GBM_KHR, device, "gbm " + node)) {
            gbm_fd_ = fd;
            gbm_device_ = device;
            return;
        }
        if (device)
            gbm_device_destroy(device);
        else
            attempts_.push_back({"gbm " + node, "gbm_create_device failed"});
        ::close(fd);
    }
    if (!any) attempts_.push_back({"gbm", "no render node /dev/dri/renderD*"});
}

}  // namespace vantage

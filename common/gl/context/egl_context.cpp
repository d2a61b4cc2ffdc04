#include "common/gl/context/egl_context.h"

#include <array>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include <EGL/eglext.h>
#include <fcntl.h>
#include <gbm.h>
#include <malloc.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"
#include "common/gl/context/context_loss.h"
#include "common/gl/context/limits.h"

namespace vantage {
namespace {

/// CurrentContext::is_none(). Thread-local, like the current context.
thread_local bool has_none = false;

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

constexpr const char* surfaceless_extension = "EGL_KHR_surfaceless_context";

bool is_software_device(EGLDeviceEXT device) {
    const auto query = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(
        eglGetProcAddress("eglQueryDeviceStringEXT"));
    return query && lists_extension(query(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
}

/// Creates a robust context where the driver supports it; EGL_NO_CONTEXT if it fails.
EGLContext create_context(EGLDisplay display, EGLConfig config, EGLContext shared) {
    constexpr std::array<EGLint, 7> robust = {EGL_CONTEXT_MAJOR_VERSION,
                                              3,
                                              EGL_CONTEXT_MINOR_VERSION,
                                              1,
                                              EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT,
                                              EGL_LOSE_CONTEXT_ON_RESET_EXT,
                                              EGL_NONE};
    constexpr std::array<EGLint, 5> plain = {EGL_CONTEXT_MAJOR_VERSION, 3,
                                             EGL_CONTEXT_MINOR_VERSION, 1, EGL_NONE};
    EGLContext context = EGL_NO_CONTEXT;
    if (makes_robust_contexts(display))
        context = eglCreateContext(display, config, shared, robust.data());
    // A robust context shares only with robust ones, and a window's context is not robust.
    if (context == EGL_NO_CONTEXT)
        context = eglCreateContext(display, config, shared, plain.data());
    return context;
}

struct GbmDeviceDeleter {
    void operator()(gbm_device* device) const { gbm_device_destroy(device); }
};

/// A render node and its GBM device.
struct GbmDevice {
    explicit GbmDevice(const std::string& node)
        : fd(::open(node.c_str(), O_RDWR | O_CLOEXEC)),
          device(fd ? gbm_create_device(fd.get()) : nullptr) {}
    UniqueFd fd;
    std::unique_ptr<gbm_device, GbmDeviceDeleter> device;
};

}  // namespace

bool makes_robust_contexts(EGLDisplay display) {
    return display != EGL_NO_DISPLAY && lists_extension(eglQueryString(display, EGL_EXTENSIONS),
                                                        "EGL_EXT_create_context_robustness");
}

std::string egl_error_name() { return egl_error_name(eglGetError()); }

std::string egl_error_name(EGLint code) {
    switch (code) {
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
        case EGL_BAD_ACCESS:
            return "EGL_BAD_ACCESS";
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
    // Beside another vendor's driver, Mesa may answer with software rendering.
    if (!has_gpu()) try_devices();
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

EglContext::EglContext(EGLDisplay display, EGLContext shared, bool needs_turns)
    : display_(display), hold_(EglDisplayHold::join(display)), needs_turns_(needs_turns) {
    if (!has_extension(surfaceless_extension))
        fail("no second OpenGL context: the driver lacks {}", surfaceless_extension);
    // The same configuration, so that every driver allows sharing.
    EGLint config_id = 0;
    if (!eglQueryContext(display, shared, EGL_CONFIG_ID, &config_id))
        fail("no second OpenGL context: the first one's configuration is unknown ({})",
             egl_error_name());
    const std::array<EGLint, 3> config_wanted = {EGL_CONFIG_ID, config_id, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display, config_wanted.data(), &config, 1, &count) || count < 1)
        fail("no second OpenGL context: configuration {} is gone ({})", config_id,
             egl_error_name());
    eglBindAPI(EGL_OPENGL_ES_API);
    context_ = create_context(display, config, shared);
    if (context_ == EGL_NO_CONTEXT)
        fail("no second OpenGL ES 3.1 context that shares with the first ({})", egl_error_name());
}

EglContext EglContext::sharing_with(const EglContext& other) {
    return {other.display_, other.context_, other.needs_turns_};
}

EglContext::~EglContext() {
    if (context_ == EGL_NO_CONTEXT) return;
    if (eglGetCurrentContext() == context_)
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    // A driver's compiler leaves freed memory with the allocator: 80 MiB of llvmpipe per reset.
    ::malloc_trim(0);
}

bool EglContext::has_extension(const char* egl_extension) const {
    return lists_extension(eglQueryString(display_, EGL_EXTENSIONS), egl_extension);
}

bool EglContext::try_platform(EGLenum platform, void* native_display, const std::string& name,
                              std::shared_ptr<void> native_owner) {
    const auto report = [&](std::string outcome) {
        attempts_.push_back({name, std::move(outcome)});
        return false;
    };
    const auto get_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
        eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (!get_display) return report("eglGetPlatformDisplayEXT is missing");
    EGLDisplay display = get_display(platform, native_display, nullptr);
    if (display == EGL_NO_DISPLAY) return report("no such platform (" + egl_error_name() + ")");
    EglDisplayHold hold = EglDisplayHold::open(display, std::move(native_owner));
    if (!hold.held()) return report("eglInitialize failed (" + egl_error_name() + ")");
    if (!lists_extension(eglQueryString(display, EGL_EXTENSIONS), surfaceless_extension))
        return report(fmt::format("{} is missing", surfaceless_extension));
    if (!eglBindAPI(EGL_OPENGL_ES_API)) return report("no OpenGL ES (" + egl_error_name() + ")");
    constexpr std::array<EGLint, 5> config_wanted = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT,
                                                     EGL_SURFACE_TYPE, 0, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display, config_wanted.data(), &config, 1, &count) || count < 1)
        return report("no configuration with OpenGL ES 3 (" + egl_error_name() + ")");
    EGLContext context = create_context(display, config, EGL_NO_CONTEXT);
    if (context == EGL_NO_CONTEXT)
        return report("no OpenGL ES 3.1 context (" + egl_error_name() + ")");
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
        const std::string reason = egl_error_name();
        eglDestroyContext(display, context);
        return report("the context cannot be made current (" + reason + ")");
    }
    const GlInfo info = GlInfo::query();
    if (ready()) {
        if (info.is_software) {
            eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
            eglDestroyContext(display, context);
            return report("the processor draws here too");
        }
        eglDestroyContext(display_, context_);
        for (EglAttempt& attempt : attempts_)
            if (attempt.outcome == "ok") attempt.outcome = "the processor draws here";
    }
    display_ = display;
    hold_ = std::move(hold);
    context_ = context;
    is_software_ = info.is_software;
    needs_turns_ = info.needs_turns();
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
        if (!ready()) attempts_.push_back({"device", "EGL lists no devices"});
        return;
    }
    for (EGLint i = 0; i < count && !has_gpu(); ++i)
        if (EGLDeviceEXT device = devices[static_cast<std::size_t>(i)];
            !ready() || !is_software_device(device))
            try_platform(EGL_PLATFORM_DEVICE_EXT, device, fmt::format("device {}", i));
}

void EglContext::try_gbm() {
    bool any = false;
    for (int minor = 128; minor < 136 && !ready(); ++minor) {
        const std::string node = fmt::format("/dev/dri/renderD{}", minor);
        if (!std::filesystem::exists(node)) continue;
        any = true;
        const auto native = std::make_shared<GbmDevice>(node);
        if (!native->fd)
            attempts_.push_back({"gbm " + node, std::strerror(errno)});
        else if (!native->device)
            attempts_.push_back({"gbm " + node, "gbm_create_device failed"});
        else
            try_platform(EGL_PLATFORM_GBM_KHR, native->device.get(), "gbm " + node, native);
    }
    if (!any) attempts_.push_back({"gbm", "no render node /dev/dri/renderD*"});
}

CurrentContext::CurrentContext()
    : display_(eglGetCurrentDisplay()),
      previous_display_(display_),
      previous_draw_(eglGetCurrentSurface(EGL_DRAW)),
      previous_read_(eglGetCurrentSurface(EGL_READ)),
      previous_(eglGetCurrentContext()),
      was_none_(std::exchange(has_none, false)) {}

bool CurrentContext::is_none() { return has_none; }

CurrentContext::CurrentContext(None) : CurrentContext() {
    has_none = true;
    if (previous_ != EGL_NO_CONTEXT)
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

CurrentContext::CurrentContext(const EglContext& context) : CurrentContext() {
    display_ = context.display_;
    if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context.context_)) return;
    const EGLint code = eglGetError();
    if (code == EGL_CONTEXT_LOST) throw ContextLost("the GPU was reset: its contexts are lost");
    fail("an OpenGL context cannot be made current on this thread ({})", egl_error_name(code));
}

CurrentContext::~CurrentContext() {
    has_none = was_none_;
    if (previous_ == EGL_NO_CONTEXT && display_ != EGL_NO_DISPLAY)
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    else if (previous_ != EGL_NO_CONTEXT)
        eglMakeCurrent(previous_display_, previous_draw_, previous_read_, previous_);
}

}  // namespace vantage

#include "common/gl/context/limits.h"

#include <charconv>
#include <cstring>
#include <string_view>

#include <GLES2/gl2ext.h>

#include "common/base/error.h"
#include "common/gl/context/context_loss.h"

namespace vantage {
namespace {

std::string gl_string(GLenum name) {
    const auto* text = reinterpret_cast<const char*>(glGetString(name));
    return text ? text : "";
}

int gl_integer(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

}  // namespace

bool has_gl_extension(const char* name) {
    const int count = gl_integer(GL_NUM_EXTENSIONS);
    for (int i = 0; i < count; ++i) {
        const auto* extension =
            reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i)));
        if (extension && std::strcmp(extension, name) == 0) return true;
    }
    return false;
}

GlInfo GlInfo::query() {
    GlInfo info;
    info.vendor = gl_string(GL_VENDOR);
    info.renderer = gl_string(GL_RENDERER);
    info.version = gl_string(GL_VERSION);
    info.max_texture_side_px = gl_integer(GL_MAX_TEXTURE_SIZE);
    info.max_colour_targets = gl_integer(GL_MAX_COLOR_ATTACHMENTS);
    info.max_workgroup_invocations = gl_integer(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS);
    info.max_shared_bytes = gl_integer(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE);
    info.has_timer_queries = has_gl_extension("GL_EXT_disjoint_timer_query");
    info.is_software = info.renderer.find("llvmpipe") != std::string::npos ||
                       info.renderer.find("softpipe") != std::string::npos;
    return info;
}

bool GlInfo::needs_turns() const {
    constexpr int first_without = 25;
    const std::string_view mark = "Mesa ";
    const std::size_t at = version.find(mark);
    int major = 0;
    if (at != std::string::npos)
        std::from_chars(version.data() + at + mark.size(), version.data() + version.size(), major);
    return is_software && major < first_without;
}

void GlInfo::require_vantage_minimum() const {
    const auto require = [&](const char* what, int has, int needs) {
        if (has < needs)
            fail("the GPU '{}' offers {} {}, and Vantage needs {}", renderer, has, what, needs);
    };
    require("pixels of texture side", max_texture_side_px, PiLimits::max_image_side_px);
    require("colour targets", max_colour_targets, PiLimits::max_colour_targets);
    require("invocations a workgroup", max_workgroup_invocations,
            PiLimits::max_workgroup_invocations);
    require("bytes of shared memory", max_shared_bytes, PiLimits::max_shared_bytes);
}

void check_gl(const char* doing) {
    require_context(doing);
    const GLenum code = glGetError();
    if (code == GL_NO_ERROR) return;
    if (code == GL_CONTEXT_LOST_KHR)
        throw ContextLost(fmt::format("the GPU was reset before {}", doing));
    while (glGetError() != GL_NO_ERROR) {
    }
    const char* name = code == GL_OUT_OF_MEMORY       ? "out of GPU memory"
                       : code == GL_INVALID_ENUM      ? "invalid enum"
                       : code == GL_INVALID_VALUE     ? "invalid value"
                       : code == GL_INVALID_OPERATION ? "invalid operation"
                                                      : "incomplete framebuffer or unknown error";
    fail("OpenGL failed while {}: {}", doing, name);
}

}  // namespace vantage

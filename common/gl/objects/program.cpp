#include "common/gl/objects/program.h"

#include <algorithm>
#include <vector>

#include <GLES2/gl2ext.h>
#include <fmt/format.h>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/gl/context/limits.h"
#include "common/gl/sliced_drawing.h"

namespace vantage {
namespace {

inline void delete_shader(GLuint name) { glDeleteShader(name); }
using Shader = GlHandle<delete_shader>;

std::string shader_log(GLuint shader) {
    GLint length = 0;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    glGetShaderInfoLog(shader, length, nullptr, log.data());
    return log;
}

Shader compile(GLenum stage, const std::string& file, const std::string& source) {
    Shader shader(glCreateShader(stage));
    const char* text = source.c_str();
    glShaderSource(shader.name(), 1, &text, nullptr);
    glCompileShader(shader.name());
    GLint ok = GL_FALSE;
    glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &ok);
    if (!ok) fail("shader {} does not compile: {}", file, shader_log(shader.name()).c_str());
    return shader;
}

bool is_sampler(GLenum type) {
    switch (type) {
        case GL_SAMPLER_2D:
        case GL_SAMPLER_3D:
        case GL_SAMPLER_CUBE:
        case GL_SAMPLER_2D_SHADOW:
        case GL_SAMPLER_CUBE_SHADOW:
        case GL_SAMPLER_2D_ARRAY:
        case GL_SAMPLER_2D_ARRAY_SHADOW:
        case GL_SAMPLER_2D_MULTISAMPLE:
        case GL_INT_SAMPLER_2D:
        case GL_INT_SAMPLER_3D:
        case GL_INT_SAMPLER_2D_ARRAY:
        case GL_UNSIGNED_INT_SAMPLER_2D:
        case GL_UNSIGNED_INT_SAMPLER_3D:
        case GL_UNSIGNED_INT_SAMPLER_2D_ARRAY:
        case GL_SAMPLER_EXTERNAL_OES:
            return true;
        default:
            return false;
    }
}

}  // namespace

Program Program::render(const ShaderLibrary& library, std::string vertex, std::string fragment,
                        ShaderDefines defines) {
    return Program(library, std::move(vertex), std::move(fragment), std::move(defines));
}

Program Program::compute(const ShaderLibrary& library, std::string file, ShaderDefines defines) {
    return Program(library, std::move(file), "", std::move(defines));
}

Program::Program(const ShaderLibrary& library, std::string first, std::string second,
                 ShaderDefines defines)
    : library_(&library),
      first_(std::move(first)),
      second_(std::move(second)),
      defines_(std::move(defines)) {
    library_->note_made(file());
    build();
}

void Program::build() {
    const bool is_compute = second_.empty();
    std::vector<Shader> shaders;
    shaders.push_back(compile(is_compute ? GL_COMPUTE_SHADER : GL_VERTEX_SHADER, first_,
                              library_->source(first_, defines_)));
    if (!is_compute)
        shaders.push_back(
            compile(GL_FRAGMENT_SHADER, second_, library_->source(second_, defines_)));
    GlHandle<delete_program> handle(glCreateProgram());
    for (const Shader& shader : shaders) glAttachShader(handle.name(), shader.name());
    glLinkProgram(handle.name());
    GLint ok = GL_FALSE;
    glGetProgramiv(handle.name(), GL_LINK_STATUS, &ok);
    if (!ok) {
        GLint length = 0;
        glGetProgramiv(handle.name(), GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
        glGetProgramInfoLog(handle.name(), length, nullptr, log.data());
        fail("shaders {} {} do not link: {}", first_, second_, log.c_str());
    }
    if (is_compute) {
        glGetProgramiv(handle.name(), GL_COMPUTE_WORK_GROUP_SIZE, workgroup_);
        const int invocations = workgroup_[0] * workgroup_[1] * workgroup_[2];
        if (invocations > PiLimits::max_workgroup_invocations)
            fail("shader {} has workgroups of {} invocations; a Raspberry Pi supports {}", first_,
                 invocations, PiLimits::max_workgroup_invocations);
    }
    handle_ = std::move(handle);
    locations_.clear();
    assign_units();
    generation_ = library_->generation();
}

void Program::assign_units() {
    units_.clear();
    GLint uniforms = 0, longest_name = 0;
    glGetProgramiv(handle_.name(), GL_ACTIVE_UNIFORMS, &uniforms);
    glGetProgramiv(handle_.name(), GL_ACTIVE_UNIFORM_MAX_LENGTH, &longest_name);
    std::vector<char> text(static_cast<std::size_t>(std::max(longest_name, 1)));
    int next = 0;
    const auto assign = [&](std::string name) {
        glProgramUniform1i(handle_.name(), glGetUniformLocation(handle_.name(), name.c_str()),
                           next);
        units_.emplace(std::move(name), next++);
    };
    for (GLint i = 0; i < uniforms; ++i) {
        GLint elements = 0;
        GLenum type = 0;
        glGetActiveUniform(handle_.name(), static_cast<GLuint>(i), longest_name, nullptr, &elements,
                           &type, text.data());
        if (!is_sampler(type)) continue;
        const std::string name(text.data());
        const auto bracket = name.find('[');
        if (bracket == std::string::npos) {
            assign(name);
            continue;
        }
        for (GLint k = 0; k < elements; ++k)
            assign(element(name.substr(0, bracket), static_cast<std::size_t>(k)));
    }
}

void Program::use() {
    if (generation_ != library_->generation()) {
        generation_ = library_->generation();
        try {
            build();
            log_info("loaded the edited shader {} {}", first_, second_);
        } catch (const Error& error) {
            log_error("{}; the last good version stays in use", error.what());
        }
    }
    if (!is_used_) {
        is_used_ = true;
        library_->note_used(file());
    }
    glUseProgram(handle_.name());
}

GLint Program::location(std::string_view name) {
    const auto [at, is_new] = locations_.try_emplace(std::string(name), -1);
    if (is_new) at->second = glGetUniformLocation(handle_.name(), at->first.c_str());
    return at->second;
}

int Program::unit(std::string_view name) const {
    const auto at = units_.find(name);
    return at != units_.end() ? at->second : -1;
}

std::string Program::element(std::string_view name, std::size_t index) {
    return fmt::format("{}[{}]", name, index);
}

void Program::set(std::string_view name, int value) { glUniform1i(location(name), value); }
void Program::set(std::string_view name, unsigned value) { glUniform1ui(location(name), value); }
void Program::set(std::string_view name, float value) { glUniform1f(location(name), value); }
void Program::set(std::string_view name, const Eigen::Vector2i& value) {
    glUniform2iv(location(name), 1, value.data());
}
void Program::set(std::string_view name, const Eigen::Vector2f& value) {
    glUniform2fv(location(name), 1, value.data());
}
void Program::set(std::string_view name, const Eigen::Vector3f& value) {
    glUniform3fv(location(name), 1, value.data());
}
void Program::set(std::string_view name, const Eigen::Vector4f& value) {
    glUniform4fv(location(name), 1, value.data());
}
void Program::set(std::string_view name, const Eigen::Matrix3f& value) {
    glUniformMatrix3fv(location(name), 1, GL_FALSE, value.data());
}
void Program::set(std::string_view name, const Eigen::Matrix4f& value) {
    glUniformMatrix4fv(location(name), 1, GL_FALSE, value.data());
}
void Program::set(std::string_view name, std::span<const Eigen::Vector4f> values) {
    if (values.empty()) return;
    glUniform4fv(location(name), static_cast<GLsizei>(values.size()), values.front().data());
}

void Program::dispatch_over(int width, int height, int depth) const {
    const auto groups = [](int invocations, int size) {
        return static_cast<GLuint>((invocations + size - 1) / size);
    };
    if (const SlicedDrawing* slices = SlicedDrawing::current()) slices->give_way();
    glDispatchCompute(groups(width, workgroup_[0]), groups(height, workgroup_[1]),
                      groups(depth, workgroup_[2]));
}

}  // namespace vantage

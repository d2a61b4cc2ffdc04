#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>

#include <Eigen/Core>
#include <GLES3/gl31.h>

#include "common/gl/objects/gl_handle.h"
#include "common/gl/shader_library.h"

namespace vantage {

inline void delete_program(GLuint name) { glDeleteProgram(name); }

/// A linked program from files of the shader library, which must outlive it. When the library has
/// noticed an edited shader (ShaderLibrary::poll), the next use() compiles anew; a shader that does
/// not compile is reported and the last good one stays.
class Program {
  public:
    /// Throws Error with the driver's log if a shader does not compile or link.
    static Program render(const ShaderLibrary& library, std::string vertex, std::string fragment,
                          ShaderDefines defines = {});
    /// Throws too if the workgroup is larger than a Raspberry Pi takes (PiLimits).
    static Program compute(const ShaderLibrary& library, std::string file,
                           ShaderDefines defines = {});

    void use();

    // Uniforms of the program in use; names that the compiler removed are ignored.
    void set(std::string_view name, int value);
    void set(std::string_view name, unsigned value);
    void set(std::string_view name, float value);
    void set(std::string_view name, const Eigen::Vector2i& value);
    void set(std::string_view name, const Eigen::Vector2f& value);
    void set(std::string_view name, const Eigen::Vector3f& value);
    void set(std::string_view name, const Eigen::Vector4f& value);
    void set(std::string_view name, const Eigen::Matrix3f& value);
    void set(std::string_view name, const Eigen::Matrix4f& value);
    /// An array of vec4 from its first element on.
    void set(std::string_view name, std::span<const Eigen::Vector4f> values);

    /// Launches enough workgroups to cover `width x height x depth` invocations; for compute
    /// programs in use.
    void dispatch_over(int width, int height, int depth = 1) const;

    GLuint name() const { return handle_.name(); }

  private:
    Program(const ShaderLibrary& library, std::string first, std::string second,
            ShaderDefines defines);
    void build();
    /// The file that names the program: of the compute or the fragment shader.
    const std::string& file() const { return second_.empty() ? first_ : second_; }
    GLint location(std::string_view name);

    const ShaderLibrary* library_;
    std::string first_, second_;  ///< vertex and fragment, or compute and nothing
    ShaderDefines defines_;
    GlHandle<delete_program> handle_;
    GLint workgroup_[3] = {1, 1, 1};
    std::uint64_t generation_ = 0;
    bool is_used_ = false;
    std::unordered_map<std::string, GLint> locations_;
};

}  // namespace vantage

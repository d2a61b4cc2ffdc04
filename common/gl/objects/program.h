#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
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

/// A linked GL program built from files of the shader library, which must outlive it. After the
/// library has noticed an edited shader (ShaderLibrary::poll), the next use() compiles it again; if
/// that fails, the error is logged and the last good program stays.
///
/// Each sampler of a program has a texture unit of its own, assigned when the program is linked. A
/// draw names its inputs and never a unit:
///
///     Program& program = pass.use();
///     program.input("depth_map", depth_m);
///     program.input("other_colour", 2, colour);  // other_colour[2]
///     program.set("edge_ratio", depth_edge_ratio);
///     pass.draw(target);
///
/// Every sampler of the program gets an input before each draw, also one that this draw does not
/// read: its unit may still hold the texture that is drawn to, which GL does not allow.
class Program {
  public:
    /// Throws Error with the driver's log if a shader does not compile or link.
    static Program render(const ShaderLibrary& library, std::string vertex, std::string fragment,
                          ShaderDefines defines = {});
    /// Throws Error also if the workgroup is larger than a Raspberry Pi supports (PiLimits).
    static Program compute(const ShaderLibrary& library, std::string file,
                           ShaderDefines defines = {});

    void use();

    /// Binds a texture to the unit of the sampler `name`; does nothing if the compiler removed the
    /// sampler. `texture` is a Texture or anything else with bind(unit).
    template <class AnyTexture>
    void input(std::string_view name, const AnyTexture& texture) {
        if (const int at = unit(name); at >= 0) texture.bind(at);
    }
    /// Binds a texture to element `index` of an array of samplers.
    template <class AnyTexture>
    void input(std::string_view name, std::size_t index, const AnyTexture& texture) {
        input(element(name, index), texture);
    }

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
    /// An array of vec4, from its first element.
    void set(std::string_view name, std::span<const Eigen::Vector4f> values);
    /// Element `index` of an array.
    template <class Value>
    void set(std::string_view name, std::size_t index, const Value& value) {
        set(element(name, index), value);
    }

    /// Launches enough workgroups to cover `width x height x depth` invocations of the compute
    /// program, which must be in use.
    void dispatch_over(int width, int height, int depth = 1) const;

    GLuint name() const { return handle_.name(); }

  private:
    Program(const ShaderLibrary& library, std::string first, std::string second,
            ShaderDefines defines);
    void build();
    void assign_units();
    /// The file name of the compute or fragment shader, which names the program.
    const std::string& file() const { return second_.empty() ? first_ : second_; }
    GLint location(std::string_view name);
    /// The texture unit of a sampler ("x", or "x[2]" of an array); -1 if the compiler removed it.
    int unit(std::string_view name) const;
    /// "name[index]"
    static std::string element(std::string_view name, std::size_t index);

    const ShaderLibrary* library_;
    std::string first_, second_;  ///< vertex and fragment shader, or compute shader and empty
    ShaderDefines defines_;
    GlHandle<delete_program> handle_;
    GLint workgroup_[3] = {1, 1, 1};
    std::uint64_t generation_ = 0;
    bool is_used_ = false;
    std::unordered_map<std::string, GLint> locations_;
    std::map<std::string, int, std::less<>> units_;
};

}  // namespace vantage

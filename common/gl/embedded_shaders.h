#pragma once

#include <span>
#include <string_view>

namespace vantage {

struct EmbeddedShader {
    std::string_view name;
    std::string_view source;
};

/// All files of shaders/, embedded by the build (shaders/CMakeLists.txt).
std::span<const EmbeddedShader> embedded_shaders();

}  // namespace vantage

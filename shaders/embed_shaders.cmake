# Writes OUTPUT, a C++ file that holds the text of all FILES by name.
set(entries "")
foreach(path ${FILES})
  get_filename_component(name ${path} NAME)
  file(READ ${path} text)
  string(APPEND entries "    {\"${name}\", R\"~glsl~(${text})~glsl~\"},\n")
endforeach()
file(WRITE ${OUTPUT} "// Made by shaders/embed_shaders.cmake.
#include \"common/gl/embedded_shaders.h\"

namespace vantage {
namespace {
constexpr EmbeddedShader shaders[] = {
${entries}};
}  // namespace
std::span<const EmbeddedShader> embedded_shaders() { return shaders; }
}  // namespace vantage
")

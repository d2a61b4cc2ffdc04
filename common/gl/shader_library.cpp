#include "common/gl/shader_library.h"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include "common/base/error.h"
#include "common/gl/embedded_shaders.h"

namespace vantage {
namespace {

constexpr int max_include_depth = 8;

std::filesystem::path folder_from_environment() {
    const char* folder = std::getenv("VANTAGE_SHADERS");
    return folder ? folder : "";
}

/// The file name of an `#include "name"` line; empty for other lines.
std::string_view include_name(std::string_view line) {
    const auto start = line.find_first_not_of(" \t");
    if (start == std::string_view::npos || line.substr(start, 8) != "#include") return {};
    const auto open = line.find('"', start);
    const auto close = open == std::string_view::npos ? open : line.find('"', open + 1);
    if (close == std::string_view::npos) return {};
    return line.substr(open + 1, close - open - 1);
}

}  // namespace

ShaderLibrary::ShaderLibrary() : ShaderLibrary(folder_from_environment()) {}

ShaderLibrary::ShaderLibrary(std::filesystem::path override_folder)
    : override_folder_(std::move(override_folder)) {
    if (!override_folder_.empty() && !std::filesystem::is_directory(override_folder_))
        fail("the shader folder {} (from VANTAGE_SHADERS) does not exist",
             override_folder_.string());
    poll();
    generation_ = 0;
}

std::string ShaderLibrary::source(std::string_view file, const ShaderDefines& defines) const {
    // The name is for tools that read sources in a driver's trace (tools/v3d).
    std::string out = fmt::format("#version 310 es\n// shader {}\n", file) +
                      "precision highp float;\n"
                      "precision highp int;\n"
                      "precision highp sampler2D;\n"
                      "precision highp usampler2D;\n"
                      "precision highp isampler2D;\n"
                      "precision highp sampler2DArray;\n"
                      "precision highp usampler2DArray;\n"
                      "precision highp image2D;\n"
                      "precision highp uimage2D;\n";
    for (const auto& [name, value] : defines) out += fmt::format("#define {} {}\n", name, value);
    out += "#line 1\n";
    expand(file, out, 0);
    return out;
}

void ShaderLibrary::expand(std::string_view file, std::string& out, int depth) const {
    if (depth > max_include_depth)
        fail("shader {}: includes are nested deeper than {}", file, max_include_depth);
    std::istringstream lines(read(file));
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        const std::string_view included = include_name(line);
        if (included.empty()) {
            out += line;
            out += '\n';
        } else {
            out += "#line 1\n";
            expand(included, out, depth + 1);
            out += fmt::format("#line {}\n", number + 1);
        }
    }
}

std::string ShaderLibrary::read(std::string_view file) const {
    if (!override_folder_.empty()) {
        const auto in_room = override_files_.find(file);
        std::ifstream in(
            in_room == override_files_.end() ? override_folder_ / file : in_room->second,
            std::ios::binary);
        if (in) return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    }
    for (const EmbeddedShader& shader : embedded_shaders())
        if (shader.name == file) return std::string(shader.source);
    fail("there is no shader named {}", file);
}

bool ShaderLibrary::poll() {
    if (override_folder_.empty()) return false;
    std::map<std::filesystem::path, std::filesystem::file_time_type> now;
    std::map<std::string, std::filesystem::path, std::less<>> files;
    std::error_code ignored;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(override_folder_, ignored)) {
        if (!entry.is_regular_file(ignored)) continue;
        now[entry.path()] = entry.last_write_time(ignored);
        files[entry.path().filename().string()] = entry.path();
    }
    if (now == seen_) return false;
    seen_ = std::move(now);
    override_files_ = std::move(files);
    ++generation_;
    return true;
}

void ShaderLibrary::note_made(std::string_view file) const {
    ++observed_->made;
    tell_observer(file);
}

void ShaderLibrary::note_used(std::string_view file) const {
    ++observed_->used;
    tell_observer(file);
}

void ShaderLibrary::tell_observer(std::string_view file) const {
    if (observed_->observer)
        observed_->observer({.made = observed_->made, .used = observed_->used, .file = file});
}

std::vector<std::string> ShaderLibrary::embedded_names() const {
    std::vector<std::string> names;
    for (const EmbeddedShader& shader : embedded_shaders()) names.emplace_back(shader.name);
    return names;
}

}  // namespace vantage

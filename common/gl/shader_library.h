#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Preprocessor definitions put before a shader, e.g. {"LANES", "16"}.
using ShaderDefines = std::vector<std::pair<std::string, std::string>>;

/// How far the programs of a ShaderLibrary are. Drivers do most of the compiling at a program's
/// first use, so `used` is what has been compiled or is being compiled.
struct ProgramProgress {
    int made = 0;           ///< programs that were linked
    int used = 0;           ///< of them, those that were used at least once
    std::string_view file;  ///< of the program that is linked or compiled now
};
using ProgramObserver = std::function<void(const ProgramProgress&)>;

/// The shaders of shaders/, by file name without the room ("stereo_luma.comp"). They are embedded
/// at build time. With the environment variable VANTAGE_SHADERS set to a folder, files found there
/// or in its subfolders win, and poll() notices when they change, so that running programs reload
/// an edited shader (see Program). Shader files have no #version line (this class writes `#version
/// 310 es` and the default precisions), include other files by name (`#include "x.glsl"`), and have
/// `#ifndef X / #define X default` for every define they take, so that each file compiles alone and
/// is validated at build.
class ShaderLibrary {
  public:
    ShaderLibrary();
    explicit ShaderLibrary(std::filesystem::path override_folder);

    /// Complete source for glShaderSource. Throws Error if there is no such shader or include.
    std::string source(std::string_view file, const ShaderDefines& defines = {}) const;

    /// Looks at the override folder; true if something changed since the last look. At most a stat
    /// per file.
    bool poll();
    /// Grows with every change that poll() saw.
    std::uint64_t generation() const { return generation_; }

    std::vector<std::string> embedded_names() const;

    /// From now on `observer` is called before a program is linked and before its first use, on the
    /// thread that does so. Null: nobody is told.
    void observe_programs(ProgramObserver observer) { observed_->observer = std::move(observer); }
    /// For Program: it is about to be linked, or used for the first time.
    void note_made(std::string_view file) const;
    void note_used(std::string_view file) const;

  private:
    struct Observed {
        std::atomic<int> made = 0, used = 0;
        ProgramObserver observer;
    };
    void tell_observer(std::string_view file) const;

    std::string read(std::string_view file) const;
    void expand(std::string_view file, std::string& out, int depth) const;

    std::filesystem::path override_folder_;
    std::map<std::filesystem::path, std::filesystem::file_time_type> seen_;
    std::map<std::string, std::filesystem::path, std::less<>> override_files_;  ///< by file name
    std::uint64_t generation_ = 0;
    std::shared_ptr<Observed> observed_ = std::make_shared<Observed>();
};

}  // namespace vantage

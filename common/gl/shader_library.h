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

/// Preprocessor definitions written before a shader: {"LANES", "16"}.
using ShaderDefines = std::vector<std::pair<std::string, std::string>>;

/// How many programs of a ShaderLibrary have been linked and used. Drivers do most of the compiling
/// at a program's first use, so `used` counts those that have been compiled or are being compiled.
struct ProgramProgress {
    int made = 0;           ///< programs that were linked
    int used = 0;           ///< of them, those that were used at least once
    std::string_view file;  ///< of the program that is being linked or compiled
};
using ProgramObserver = std::function<void(const ProgramProgress&)>;

/// The shaders of shaders/, by file name without the folder ("stereo_luma.comp"), embedded at build
/// time. If the environment variable VANTAGE_SHADERS names a folder, files in it or its subfolders
/// replace embedded ones, and poll() notices their changes, so that running programs reload edited
/// shaders (see Program). Shader files have no #version line: this class writes `#version 310 es`
/// and the default precisions. They include other files by name (`#include "x.glsl"`) and have a
/// default for each define (`#ifndef X / #define X ...`), so that the build can validate each file
/// alone.
class ShaderLibrary {
  public:
    ShaderLibrary();
    explicit ShaderLibrary(std::filesystem::path override_folder);

    /// The complete source for glShaderSource. Throws Error for an unknown shader or include.
    std::string source(std::string_view file, const ShaderDefines& defines = {}) const;

    /// Checks the override folder; true if a file changed since the last call. Costs at most one
    /// stat per file.
    bool poll();
    /// Increases with every change that poll() noticed.
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

#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <opencv2/core/types.hpp>

#include "common/take/take_reader.h"
#include "host_app/synthesis/stereoscopy.h"

namespace vantage {

// Options and help texts that several commands share.

/// Help of --stage, with the place of the documented example in the sources and in the packages.
inline constexpr const char* stage_file_help =
    "Stage file (TOML); every key is in hw_config/stage.toml (installed: "
    "/usr/share/doc/vantage/examples/stage.toml)";
/// Help of --trace.
inline constexpr const char* trace_help =
    "Write when each step of the way from input and rigs to the outputs ran, as a trace for "
    "Perfetto (JSON; docs/develop/testing.md)";
/// The files that --wheels accepts.
inline constexpr const char* wheel_files_help =
    "a file such as those in hw_config/jog (installed: /usr/share/doc/vantage/examples/jog), or a "
    "folder of them (TOML)";

/// Groups of `vantage live --help` and `vantage play --help`.
namespace option_group {
inline constexpr const char* input = "Input";
inline constexpr const char* camera = "Camera";
inline constexpr const char* picture = "Picture";
inline constexpr const char* output = "Output";
inline constexpr const char* control = "Control";
inline constexpr const char* recording = "Recording";
inline constexpr const char* stereoscopic = "3-D";
inline constexpr const char* expert = "Expert";
}  // namespace option_group

/// Accepts the old name of a renamed option for one release. The old name sets the option, logs one
/// warning and is hidden from the help.
void accept_old_name(CLI::App& command, CLI::Option* option, const std::string& old_name);

/// Parses "1280x720"; each side is 16 to 4096 px. Throws Error otherwise.
cv::Size parse_size(const std::string& text);

/// Parses a frame rate of 0.1 to 240 Hz: "25", "29.97" or "30000/1001". Throws Error otherwise.
double parse_rate(const std::string& text);

/// Parses a time in a take of pulses `first` to `last`: "12.5" is seconds after the beginning,
/// "10:00:12:05" is a time code in the process's time zone. The result may be `last` + 1. Throws
/// Error for any other text, and for a time code that is not in the take.
std::uint64_t pulse_of(const TakeReader& take, const std::string& text, std::uint64_t first,
                       std::uint64_t last);

/// The options of stereoscopic pictures.
struct StereoscopicOptions {
    std::string layout = "off", quilt;
    Stereoscopy eyes;

    /// Adds the options to a group of the help and returns --stereoscopic. `default_convergence`
    /// describes the default of --convergence-m.
    CLI::Option* add_to(CLI::App& command, const std::string& default_convergence,
                        const std::string& group);

    /// Returns the requested layout, or nothing without --stereoscopic. Throws Error for a --quilt
    /// that does not parse or that another layout was requested with.
    std::optional<Stereoscopy> stereoscopy() const;
};

}  // namespace vantage

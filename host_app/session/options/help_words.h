#pragma once

namespace vantage {

// Help that several commands have, with the places of what documents a file: in the sources, and
// where the packages put it.

inline constexpr const char* stage_file_help =
    "The stage (TOML); every key is in hw_config/stage.toml (installed: "
    "/usr/share/doc/vantage/examples/stage.toml)";
inline constexpr const char* wheel_files_help =
    "a file like those in hw_config/jog (installed: /usr/share/doc/vantage/examples/jog), or a "
    "folder of them (TOML)";

}  // namespace vantage

#pragma once

namespace vantage {

/// Of `--config`, with the places of what documents the file: in the sources, and where the package
/// puts it.
inline constexpr const char* rig_file_help =
    "The rig (TOML); every key is in hw_config/rig.toml (installed: /etc/vantage/rig.toml)";

}  // namespace vantage

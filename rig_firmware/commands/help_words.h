#pragma once

namespace vantage {

/// Help text for `--config`. It names the documented configuration file in the sources and in the
/// installed package.
inline constexpr const char* rig_file_help =
    "Read this rig file (TOML); every key is in hw_config/rig.toml (installed: "
    "/etc/vantage/rig.toml)";

}  // namespace vantage

#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string_view>

#include "common/base/files/embedded_text.h"
#include "host_app/control/ports/messages/rosstalk_line.h"
#include "host_app/control/table/control_command.h"

namespace vantage {

/// Map of RossTalk commands to commands of Vantage, like the buttons in a jog wheel's profile.
class RossTalkMap {
  public:
    /// Loads a file like hw_config/rosstalk/standard.toml, or the built-in copy of it if the path
    /// is empty. Throws Error with file and line.
    static RossTalkMap load(const std::filesystem::path& path);
    static RossTalkMap read(std::string_view text, const std::filesystem::path& name);

    /// Null if the command is not mapped.
    const CommandCall* find(const RossTalkOrder& order) const;

  private:
    std::map<int, CommandCall> gpi_;
    std::map<std::pair<int, int>, CommandCall> xpt_;
};

/// Built-in copies of the files in hw_config/rosstalk.
std::span<const EmbeddedText> embedded_rosstalk();

}  // namespace vantage

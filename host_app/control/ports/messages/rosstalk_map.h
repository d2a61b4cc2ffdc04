#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string_view>

#include "common/base/files/embedded_text.h"
#include "host_app/control/ports/messages/rosstalk_line.h"
#include "host_app/control/table/control_command.h"

namespace vantage {

/// What the commands of a RossTalk device do, as a jog wheel's file says it of buttons.
class RossTalkMap {
  public:
    /// Reads a file like hw_config/rosstalk/standard.toml, or that one itself where there is no
    /// path. Throws Error with file and line for whatever does not fit.
    static RossTalkMap load(const std::filesystem::path& path);
    static RossTalkMap read(std::string_view text, const std::filesystem::path& name);

    /// Null: it is mapped to nothing.
    const CommandCall* find(const RossTalkOrder& order) const;

  private:
    std::map<int, CommandCall> gpi_;
    std::map<std::pair<int, int>, CommandCall> xpt_;
};

/// The files of hw_config/rosstalk as they were built in.
std::span<const EmbeddedText> embedded_rosstalk();

}  // namespace vantage

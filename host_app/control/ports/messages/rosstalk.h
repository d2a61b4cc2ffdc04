#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "common/base/files/embedded_text.h"
#include "host_app/control/table/control_command.h"

namespace vantage {

/// Splits the bytes of a connection into lines. A line ends with CR LF, LF or CR; empty lines are
/// skipped.
class LineSplitter {
  public:
    void take(std::string_view bytes) { waiting_ += bytes; }
    /// Next complete line without its end; empty if there is none yet.
    std::optional<std::string> next() {
        for (;;) {
            const std::size_t end = waiting_.find_first_of("\r\n");
            if (end == std::string::npos) return std::nullopt;
            std::string line = waiting_.substr(0, end);
            waiting_.erase(0, end + 1);
            if (!line.empty()) return line;
        }
    }
    /// Bytes after the last end of a line.
    const std::string& rest() const { return waiting_; }
    /// True if more bytes than the longest line arrived without an end; the connection should be
    /// closed.
    bool is_flooded() const { return waiting_.size() > most_line_bytes; }

    static constexpr std::size_t most_line_bytes = 128;

  private:
    std::string waiting_;
};

/// RossTalk command that Vantage supports: GPI n, XPT D:S.
struct RossTalkOrder {
    enum class Kind { gpi, xpt } kind = Kind::gpi;
    int first = 0, second = 0;  ///< the number, or destination and source
    bool operator==(const RossTalkOrder&) const = default;
};

/// Result of parsing a line without its end. `order` is empty if the line is not such a command;
/// commands are case-sensitive. `is_known` is true if the line begins like one.
struct RossTalkLine {
    std::optional<RossTalkOrder> order;
    bool is_known = false;
};
RossTalkLine parse_rosstalk(std::string_view line);

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

#pragma once

#include <optional>
#include <string>
#include <string_view>

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

}  // namespace vantage

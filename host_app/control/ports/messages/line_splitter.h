#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vantage {

/// Takes the bytes of a connection apart into lines. A line ends with CR LF, LF or CR; empty lines
/// are left out.
class LineSplitter {
  public:
    void take(std::string_view bytes) { waiting_ += bytes; }
    /// The next whole line without its end; nothing: none has come yet.
    std::optional<std::string> next() {
        for (;;) {
            const std::size_t end = waiting_.find_first_of("\r\n");
            if (end == std::string::npos) return std::nullopt;
            std::string line = waiting_.substr(0, end);
            waiting_.erase(0, end + 1);
            if (!line.empty()) return line;
        }
    }
    /// What came after the last end of a line.
    const std::string& rest() const { return waiting_; }
    /// More came without an end than a line has; nothing of it is worth waiting for.
    bool is_flooded() const { return waiting_.size() > most_line_bytes; }

    static constexpr std::size_t most_line_bytes = 128;

  private:
    std::string waiting_;
};

}  // namespace vantage

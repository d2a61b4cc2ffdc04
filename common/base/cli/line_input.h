#pragma once

#include <optional>
#include <string>

namespace vantage {

/// Reads whole lines from a file descriptor without blocking, for loops that also wait for other
/// events.
class LineInput {
  public:
    /// The descriptor (0 is standard input) stays open when this object is destroyed.
    explicit LineInput(int fd) : fd_(fd) {}

    int fd() const { return fd_; }
    /// Whether the end of the input was reached.
    bool is_at_end() const { return is_at_end_; }
    /// Returns the next whole line without its end, at most 1 KiB long, if there is one. Call it
    /// when the descriptor is readable; it never blocks otherwise.
    std::optional<std::string> take();

  private:
    std::optional<std::string> next();

    int fd_;
    std::string text_;
    bool is_at_end_ = false;
};

}  // namespace vantage
